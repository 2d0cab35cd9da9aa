"""A punch on a wider foundation, both under one pressure: stress is uniform across the interface and beside it."""
from lib.case import Case, Outcome, Quantity
from lib.measures import affine_error, plane_strain
from lib.model import FRICTIONLESS, Model
from lib.solution import solve

YOUNG, POISSON, PRESSURE = 1e6, 0.3, 1e3


def run(n, family="ALM", slave="punch", friction=None, shape="2D4N", **units):
    m = Model(2, **units)
    base = m.box("Base", shape, [2 * n, n], [-1.0, -1.0], [1.0, 0.0], distortion=0.15)
    punch = m.box("Punch", shape, [n + 1, n], [-0.5, 0.0], [0.5, 1.0], distortion=0.15)
    for body in (base, punch):
        m.material(body, "strain", YOUNG, POISSON)
    m.roll(base.side_nodes["y0"], y=0.0)
    gradient = plane_strain(YOUNG, POISSON, 0.0, -PRESSURE)
    for body, side in ((base, "y0"), (punch, "y1")):  # one node of each holds it sideways
        corner = min(body.side_nodes[side], key=lambda i: m.mesh.nodes[i][0])
        m.roll([corner], x=gradient[0][0] * m.mesh.nodes[corner][0])
    m.traction(punch, "y1", (0.0, -PRESSURE))
    m.traction(base, "y1", (0.0, -PRESSURE), where=lambda p: abs(p[0]) > 0.5)
    sides = [(punch, "y0"), (base, "y1", lambda p: abs(p[0]) < 0.5)]
    m.interface(*(sides if slave == "punch" else sides[::-1]))
    s = solve(m, family, friction=friction, solver={"residual_relative_tolerance": 1e-9}, settings={} if family.startswith("MPC") else {"contact_residual_relative_tolerance": 1e-9})
    values = {"strain error": max(affine_error(s, b, gradient) for b in (base, punch))}
    if not family.startswith("MPC"):
        values["pressure error"] = max(abs(p / PRESSURE * (1 + gradient[0][0]) - 1.0) for p in s.pressure().values())
    return Outcome(s, values)


CASE = Case(
    "Patch test: punch on a foundation", "R. L. Taylor, P. Papadopoulos, On a patch test for contact problems in two dimensions (1991)",
    "ANALYTIC", "Stress is uniform and displacement affine in each body, which a mortar method reproduces; the tolerance is that of the "
    "iteration. Tractions act on the present area, 1.4e-3 larger.",
    [Quantity("strain error", 0.0, {"": 1e-7, "Uzawa": 2e-4, "hexahedra, Uzawa": 2e-4}, scale=1.0, order=False), Quantity("pressure error", 0.0, {"": 1e-6, "Uzawa": 2e-4, "hexahedra, Uzawa": 2e-4}, scale=1.0, order=False)],
    (2, 4, 8), run, size=lambda n: 1 / n,
    variants={**{f: {"family": f} for f in FRICTIONLESS}, "ALM frictional": {"family": "ALM frictional", "friction": 0.3},
              "foundation as slave": {"slave": "base"}, "triangles": {"shape": "2D3N"}, "metres to millimetres": {"length": 1e3, "stress": 1e-6}},
    quick=["ALM", "ALM components", "ALM frictional", "foundation as slave", "triangles"])
