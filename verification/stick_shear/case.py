"""Two blocks of unlike meshes, pressed and sheared below the bound of friction, behave as one."""
from lib.case import Case, Outcome, Quantity
from lib.measures import affine_error, plane_strain, solid
from lib.model import Model
from lib.solution import solve

YOUNG, POISSON, PRESSURE, SHEAR, FRICTION = 1e6, 0.0, 1e3, 240.0, 0.3


def run(n, family="ALM frictional", dim=2, slave="upper", shape=None, turn=0.0, **units):
    m, up, last = Model(dim, turn=turn, axis=(0.0, 0.0, 1.0) if dim == 2 else (1.0, 2.0, 0.5), **units), "xyz"[dim - 1], dim - 1
    shape = shape or ("2D4N" if dim == 2 else "3D8N")
    low = m.box("Lower", shape, [n] * last + [2], [0.0] * last + [-0.5], [1.0] * last + [0.0])
    top = m.box("Upper", shape, [n + 1] * last + [2], [0.0] * dim, [1.0] * last + [0.5])
    for body in (low, top):
        m.material(body, "3d" if dim == 3 else "strain", YOUNG, POISSON)
    m.fix(low.side_nodes[up + "0"], *[0.0] * dim)
    m.traction(top, up + "1", [SHEAR] + [0.0] * (dim - 2) + [-PRESSURE])
    for body in (low, top):
        for end, sign in (("0", -1.0), ("1", 1.0)):
            m.traction(body, "x" + end, [0.0] * last + [sign * SHEAR])
    sides = [(top, up + "0"), (low, up + "1")]
    m.interface(*(sides if slave == "upper" else sides[::-1]))
    friction = None if family in ("tie", "MPC tie") else FRICTION
    s = solve(m, family, friction=friction)
    g = [[0.0] * dim for _ in range(dim)]
    g[last][last] = -PRESSURE / YOUNG
    g[0][last] = 2 * SHEAR / YOUNG
    values = {"strain error": max(affine_error(s, b, g) for b in (low, top))}
    u, at = s.u(top.nodes), s.at(top.nodes)
    slip = [u[i][0] - g[0][last] * (at[i][last] + 0.5) for i in top.side_nodes[up + "0"]]
    values["slip"] = sum(slip) / len(slip) / g[0][last]
    return Outcome(s, values)


CASE = Case(
    "Sheared blocks that stick", "uniform pressure and shear; the ratio of shear and pressure is 0.8 μ", "ANALYTIC",
    "Displacement is affine across the interface. Loads count on the undeformed and contact on the present area, which differ by strains "
    "of 1e-3; a penalty adds its elastic slip.",
    [Quantity("strain error", 0.0, {"": 2e-3}, scale=1.0, order=False), Quantity("slip", 0.0, {"": 1e-3}, scale=1.0, order=False)],
    (2, 4), run, size=lambda n: 1 / n,
    variants={"ALM": {}, "lower as slave": {"slave": "lower"}, "penalty": {"family": "penalty frictional"}, "MPC": {"family": "MPC frictional"},
              "tie": {"family": "tie"}, "turned by 33°": {"turn": 33.0}, "space": {"dim": 3}, "space, turned by 40°": {"dim": 3, "turn": 40.0},
              "space, tetrahedra": {"dim": 3, "shape": "3D4N"}, "space, penalty": {"dim": 3, "family": "penalty frictional"},
              "space, MPC": {"dim": 3, "family": "MPC frictional"}, "millimetres": {"length": 1e3, "stress": 1e-6}},
    quick=["ALM", "space"])
