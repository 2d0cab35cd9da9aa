"""A block that rests on an incline by friction alone."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

YOUNG, POISSON, WEIGHT = 1e6, 0.2, 1e3


def run(n, family="ALM frictional", degrees=15.0, friction=0.3, dim=2, turned=False, slave="block", steps=1, **units):
    """The slope is in the direction of gravity, or (`turned`) in the mesh."""
    angle = math.radians(degrees)
    m, up, last = Model(dim, turn=degrees if turned else 0.0, axis=(0.0, 0.0, 1.0) if dim == 2 else (0.0, -1.0, 0.0), **units), "xyz"[dim - 1], dim - 1
    shape = "2D4N" if dim == 2 else "3D8N"
    slope = m.box("Slope", shape, [2 * n] * last + [1], [-0.7] * last + [-0.3], [1.7] * last + [0.0])
    block = m.box("Block", shape, [n + 1] * last + [n], [0.0] * dim, [1.0] * last + [0.5])
    along, down = -math.sin(angle), -math.cos(angle)
    pull = [0.0] * 3
    pull[0], pull[last] = along, down
    for body, density in ((slope, 0.0), (block, WEIGHT)):
        m.material(body, "3d" if dim == 3 else "strain", YOUNG, POISSON, DENSITY=density or 1.0,
                   VOLUME_ACCELERATION=[c * m.stress / m.length * (density > 0) for c in m.direct(pull)])
    m.fix(slope.nodes, *[0.0] * dim)
    sides = [(block, up + "0"), (slope, up + "1")]
    m.interface(*(sides if slave == "block" else sides[::-1]))
    s = solve(m, family, friction=friction, steps=steps)
    p, q, area = s.pressure(), s.shear(), s.area()
    normal, tangent = sum(p[i] * area[i] for i in p), sum(q[i][0] * area[i] for i in p)
    u = s.u(block.nodes)
    return Outcome(s, {"T over N": abs(tangent) / normal, "N over weight": normal / (0.5 * WEIGHT * math.cos(angle)),
                       "largest displacement": max(math.hypot(*v) for v in u.values())})


CASE = Case(
    "Block on an incline", "Coulomb's law: a block stays while tan α < μ, with T = N tan α", "ANALYTIC",
    "Forces are in balance to the tolerance of the iteration; the block moves by its strain only, 0.1 % at most.",
    [Quantity("T over N", lambda v: math.tan(math.radians(v.get("degrees", 15.0))), 2e-3, order=False),
     Quantity("N over weight", 1.0, 2e-3, order=False), Quantity("largest displacement", 0.0, 1e-3, scale=1.0, order=False)],
    (2, 4), run, size=lambda n: 1 / n,
    variants={"15°": {}, "16.6°, just below tan α = μ": {"degrees": 16.6}, "the mesh is turned": {"turned": True}, "slope as slave": {"slave": "slope"},
              "space": {"dim": 3}, "space, the mesh is turned": {"dim": 3, "turned": True}, "4 steps": {"steps": 4}, "penalty": {"family": "penalty frictional"},
              "millimetres": {"length": 1e3, "stress": 1e-6}}, quick=["15°"])
