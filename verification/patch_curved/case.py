"""Two bodies of one material under pressure from all sides, cut by an arc and meshed unlike: pressure is uniform in the limit."""
import math

from lib.case import Case, Outcome, Quantity
from lib.measures import affine_error, plane_strain, rms
from lib.model import FRICTIONLESS, Model
from lib.solution import solve

YOUNG, POISSON, PRESSURE, RADIUS = 1e6, 0.3, 2e4, 1.2


def run(n, family="ALM", friction=None, slave="upper", **units):
    m = Model(2, **units)
    cut = lambda x: 0.4 + math.sqrt(RADIUS ** 2 - (x - 0.5) ** 2) - math.sqrt(RADIUS ** 2 - 0.25)
    low = m.box("Lower", "2D4N", [n, n], [0.0, 0.0], [1.0, 1.0], lambda x, y: (x, y * cut(x)))
    top = m.box("Upper", "2D4N", [n + n // 2, n], [0.0, 1.0], [1.0, 2.0], lambda x, y: (x, cut(x) + (y - 1.0) * (1.2 - cut(x))))
    for body in (low, top):
        m.material(body, "strain", YOUNG, POISSON)
        m.roll(body.side_nodes["x0"], x=0.0)
        m.traction(body, "x1", (-PRESSURE, 0.0))
    m.roll(low.side_nodes["y0"], y=0.0)
    m.traction(top, "y1", (0.0, -PRESSURE))
    sides = [(top, "y0"), (low, "y1")]
    m.interface(*(sides if slave == "upper" else sides[::-1]))
    s = solve(m, family, friction=friction)
    gradient = plane_strain(YOUNG, POISSON, -PRESSURE, -PRESSURE)
    values = {"strain error": max(affine_error(s, b, gradient) for b in (low, top))}
    if not family.startswith("MPC"):
        values["pressure error, mean"] = rms(p * (1 + gradient[0][0]) / PRESSURE - 1.0 for p in s.pressure().values())
    return Outcome(s, values)


CASE = Case(
    "Patch test: curved interface", "uniform pressure on a body cut by an arc (after Puso and Laursen, CMAME 193, 2004)", "ANALYTIC",
    "Facets of non-matching meshes on an arc leave gaps of second order in the mesh size, which affect the pressure.",
    [Quantity("strain error", 0.0, (0.1, 0.03, 0.008), scale=1.0), Quantity("pressure error, mean", 0.0, (0.2, 0.1, 0.05), scale=1.0)],
    (8, 16, 32), run, size=lambda n: 1 / n,
    variants={**{f: {"family": f} for f in FRICTIONLESS}, "lower as slave": {"slave": "lower"},
              "ALM frictional": {"family": "ALM frictional", "friction": 0.3}, "millimetres": {"length": 1e3, "stress": 1e-6}},
    quick=["ALM"])
