"""A block slides over a surface that resists less across its lay than along it."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model, ramp
from lib.solution import norm, solve

YOUNG, POISSON, FRICTION, RATIO, PRESSED, DRAG = 1e6, 0.3, 0.4, 0.5, 1e-3, 0.8


def traction(angle):
    """Traction over the pressure along the motion and across it, at this angle of the motion to the lay, in degrees."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    size = math.hypot(c, RATIO * s)
    along, across = FRICTION * c / size, FRICTION * RATIO ** 2 * s / size
    return along * c + across * s, across * c - along * s


def run(n, family="ALM frictional", angle=30.0, turn=0.0, **units):
    m = Model(3, turn=turn, axis=(0.0, 0.0, 1.0), **units)
    ground = m.box("Ground", "3D8N", [3 * n, 3 * n, 1], [-1.0, -1.0, -0.2], [2.0, 2.0, 0.0])
    block = m.box("Block", "3D8N", [n + 1, n + 1, n], [0.0] * 3, [1.0, 1.0, 0.5])
    for body in (ground, block):
        m.material(body, "3d", YOUNG, POISSON)
    m.fix(ground.nodes, 0.0, 0.0, 0.0)
    steps = 5
    m.fix(block.side_nodes["z1"], f"{DRAG!r}*{ramp(1.0, float(steps))}", "0.0", f"{-PRESSED!r}*{ramp(0.0, 1.0)}")
    m.interface((block, "z0"), (ground, "z1"))
    lay = m.direct([math.cos(math.radians(angle)), -math.sin(math.radians(angle)), 0.0])
    s = solve(m, family, friction=FRICTION, end=float(steps), steps=steps,
              contact={"friction_direction": lay, "friction_ratio": RATIO})
    force = s.reaction(block.side_nodes["z1"])  # of the drive: along, across, down
    normal = -force[2]
    right = traction(angle)
    deviation = math.hypot(force[0] / normal - right[0], force[1] / normal - right[1]) / math.hypot(*right)
    turned = math.degrees(math.atan2(force[1], force[0]) - math.atan2(right[1], right[0]))
    balance = [a + b for a, b in zip(force, s.reaction(ground.nodes))]
    return Outcome(s, {"force off the ellipse": deviation, "angle of the force": turned, "balance": norm(balance) / norm(force)})


CASE = Case(
    "Sliding by direction", "associated slip on an elliptic limit of friction (Michałowski and Mróz 1978)", "ANALYTIC",
    "All nodes slide along the motion once the block has deflected across it; the tolerance is that of the iteration (1e-4).",
    [Quantity("force off the ellipse", 0.0, 1e-3, scale=1.0, order=False), Quantity("angle of the force", 0.0, 0.1, "°", scale=1.0, order=False),
     Quantity("balance", 0.0, 1e-3, scale=1.0, order=False)],
    (2, 4), run, size=lambda n: 1 / n,
    variants={"30°": {}, "0°": {"angle": 0.0}, "70°": {"angle": 70.0}, "−45°": {"angle": -45.0}, "90°": {"angle": 90.0},
              "30°, turned by 40°": {"turn": 40.0}, "30°, millimetres": {"length": 1e3, "stress": 1e-6}},
    quick=["30°"],
    note="The coefficient is 0.4 along the lay and 0.2 across it. The slip is normal to the ellipse of the limit, so that the traction turns off the motion.")
