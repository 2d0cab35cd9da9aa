"""A block pressed on rigid ground by N and dragged in any direction resists with T = μ N against the motion."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model, ramp
from lib.solution import norm, solve

YOUNG, POISSON, FRICTION, PRESSED, DRAG = 1e6, 0.3, 0.3, 1e-3, 0.05


def run(n, family="ALM frictional", dim=2, along=0.0, turn=0.0, friction=FRICTION, slave="block", shape=None, steps=2, **units):
    m, up, last = Model(dim, turn=turn, axis=(0.0, 0.0, 1.0) if dim == 2 else (1.0, 1.0, 0.3), **units), "xyz"[dim - 1], dim - 1
    shape = shape or ("2D4N" if dim == 2 else "3D8N")
    ground = m.box("Ground", shape, [3 * n] * last + [1], [-1.0] * last + [-0.2], [2.0] * last + [0.0])
    block = m.box("Block", shape, [n + 1] * last + [n], [0.0] * dim, [1.0] * last + [0.5])
    for body in (ground, block):
        m.material(body, "3d" if dim == 3 else "strain", YOUNG, POISSON)
    m.fix(ground.nodes, *[0.0] * dim)
    angle = math.radians(along)
    way = (math.cos(angle), math.sin(angle)) if dim == 3 else (math.cos(angle),)
    # pressed in the first step, dragged in the others
    down = f"{-PRESSED!r}*{ramp(0.0, 1.0)}"
    m.fix(block.side_nodes[up + "1"], *[f"{DRAG * w!r}*{ramp(1.0, float(steps))}" for w in way], down)
    sides = [(block, up + "0"), (ground, up + "1")]
    m.interface(*(sides if slave == "block" else sides[::-1]))
    s = solve(m, family, friction=friction, end=float(steps), steps=steps)
    force = s.reaction(block.side_nodes[up + "1"])  # of the drive: forward and down
    normal, size = -force[last], math.hypot(*force[:last])
    cosine = sum(a * b for a, b in zip(force, way)) / size if size else -1.0
    turned = math.degrees(math.acos(max(-1.0, min(1.0, cosine))))
    balance = [a + b for a, b in zip(force, s.reaction(ground.nodes))]
    return Outcome(s, {"T over μN": size / (friction * normal), "angle to the motion": turned,
                       "balance": norm(balance) / norm(force)})


CASE = Case(
    "Sliding in any direction", "Coulomb's law", "ANALYTIC",
    "All nodes slide, so that forces satisfy the law exactly; the tolerance is that of the iteration (1e-4).",
    [Quantity("T over μN", 1.0, 1e-3, order=False), Quantity("angle to the motion", 0.0, 0.1, "°", scale=1.0, order=False),
     Quantity("balance", 0.0, 1e-3, scale=1.0, order=False)],
    (2, 4), run, size=lambda n: 1 / n,
    variants={"plane": {}, "plane, backwards": {"along": 180.0}, "plane turned by 25°": {"turn": 25.0}, "ground as slave": {"slave": "ground"},
              "plane, penalty": {"family": "penalty frictional"}, "plane, MPC": {"family": "MPC frictional"},
              "space, 0°": {"dim": 3}, "space, 30°": {"dim": 3, "along": 30.0}, "space, 215°": {"dim": 3, "along": 215.0},
              "space, 30°, turned by 40°": {"dim": 3, "along": 30.0, "turn": 40.0}, "space, tetrahedra": {"dim": 3, "along": 75.0, "shape": "3D4N"},
              "space, 30°, penalty": {"dim": 3, "along": 30.0, "family": "penalty frictional"},
              "space, 30°, MPC": {"dim": 3, "along": 30.0, "family": "MPC frictional"},
              "space, 30°, millimetres": {"dim": 3, "along": 30.0, "length": 1e3, "stress": 1e-6},
              "plane, μ = 1": {"friction": 1.0}, "plane, 5 steps": {"steps": 5}},
    quick=["plane, 5 steps"])
