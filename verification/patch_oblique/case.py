"""Two bodies of one material under pressure from all sides, cut by a sloped plane: nothing slides, whatever the slope."""
from lib.case import Case, Outcome, Quantity
from lib.measures import affine_error, plane_strain, solid
from lib.model import FRICTIONLESS, Model
from lib.solution import solve

YOUNG, POISSON, PRESSURE, RISE = 1e6, 0.3, 1e3, 0.25


def run(n, family="ALM", shapes=("2D4N", "2D4N"), friction=None, slave="upper", rise=RISE, **units):
    dim = int(shapes[0][0])
    m, up, last = Model(dim, **units), "xyz"[dim - 1], dim - 1
    cut = lambda p: 0.5 + rise * p[0] + (0.1 * p[1] if dim == 3 else 0.0)
    low = m.box("Lower", shapes[0], [n] * last + [2], [0.0] * dim, [1.0] * dim, lambda *p: (*p[:last], p[last] * cut(p)))
    top = m.box("Upper", shapes[1], [n + 1] * last + [2], [0.0] * last + [1.0], [1.0] * last + [2.0],
                lambda *p: (*p[:last], cut(p) + (p[last] - 1.0) * (1.5 - cut(p))))
    for body in (low, top):
        m.material(body, "3d" if dim == 3 else "strain", YOUNG, POISSON)
        for d, axis in enumerate("xyz"[:last]):
            m.roll(body.side_nodes[axis + "0"], **{axis: 0.0})
            v = [0.0] * dim
            v[d] = -PRESSURE
            if body is low or rise < 1.0:  # at 45° the upper body ends in an edge
                m.traction(body, axis + "1", v)
    m.roll(low.side_nodes[up + "0"], **{up: 0.0})
    m.traction(top, up + "1", [0.0] * last + [-PRESSURE])
    sides = [(top, up + "0"), (low, up + "1")]
    m.interface(*(sides if slave == "upper" else sides[::-1]))
    tight = {} if family.startswith("MPC") else {"contact_residual_relative_tolerance": 1e-9}
    s = solve(m, family, friction=friction, solver={"residual_relative_tolerance": 1e-9}, settings=tight)
    gradient = plane_strain(YOUNG, POISSON, -PRESSURE, -PRESSURE) if dim == 2 else solid(YOUNG, POISSON, *[-PRESSURE] * 3)
    values = {"strain error": max(affine_error(s, b, gradient) for b in (low, top))}
    if not family.startswith("MPC"):
        squeezed = (1 + gradient[0][0]) ** (dim - 1)
        values["pressure error"] = max(abs(p * squeezed / PRESSURE - 1.0) for p in s.pressure().values())
    return Outcome(s, values)


CUBES = {"shapes": ("3D8N", "3D8N")}
CASE = Case(
    "Patch test: oblique interface", "uniform pressure on a body cut by a plane (after Crisfield 2000; El-Abbasi and Bathe 2001)", "ANALYTIC",
    "Pressure is uniform and displacement affine; the tolerance is that of the iteration, for Uzawa's that of its multipliers; penalties yield by 1e-4 of an element.",
    [Quantity("strain error", 0.0, {"": 1e-7, "Uzawa": 2e-4, "hexahedra, penalty": 1e-4}, scale=1.0, order=False), Quantity("pressure error", 0.0, {"": 1e-6, "Uzawa": 2e-4}, scale=1.0, order=False)],
    (2, 5), run, size=lambda n: 1 / n,
    variants={**{f: {"family": f} for f in FRICTIONLESS}, "lower as slave": {"slave": "lower"},
              "ALM frictional": {"family": "ALM frictional", "friction": 0.3}, "slope of 45°": {"rise": 1.0}, "triangles": {"shapes": ("2D3N", "2D3N")},
              "hexahedra": CUBES, "tetrahedra": {"shapes": ("3D4N", "3D4N")}, "tetrahedra on hexahedra": {"shapes": ("3D8N", "3D4N")},
              "tetrahedra, frictional": {"shapes": ("3D4N", "3D4N"), "family": "ALM frictional", "friction": 0.3},
              "hexahedra, MPC": {**CUBES, "family": "MPC"}, "hexahedra, penalty": {**CUBES, "family": "penalty"}},
    quick=["ALM", "tetrahedra"])
