"""Two cylinders pressed, then sheared: slip spreads from the edges of the contact."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model, ramp
from lib.shapes import bulge, mirrored, scaled, stations
from lib.solution import solve

YOUNG, POISSON, HALF, FRICTION, RATIO = 1e3, 0.3, 1.0, 0.2, 0.004
MODULUS, RADIUS = YOUNG / (2 * (1 - POISSON ** 2)), HALF / RATIO
FORCE = math.pi * HALF ** 2 * MODULUS / (4 * (RADIUS / 2))
PEAK = 2 * FORCE / (math.pi * HALF)


def run(n, family="ALM frictional", share=0.5, steps=4, slave="upper", **units):
    """`share` is that of the bound of friction; pressed in one step, sheared in `steps`."""
    width = 40.0 * HALF
    m, bodies = Model(2, **units), []
    for name, sign, size in (("Lower", -1, 1.0 / n), ("Upper", 1, 0.9 / n)):
        s = scaled(stations(size, 0.0, width))
        s = s if sign > 0 else [1.0 - v for v in reversed(s)]
        bodies.append(m.graded(name, "2D4N", [mirrored(stations(size, 1.3, width)), s], bulge(RADIUS, 3.0, width, sign)))
        m.material(bodies[-1], "strain", YOUNG, POISSON)
    lower, upper = bodies
    m.fix(lower.side_nodes["y0"], x=0.0, y=0.0)
    m.rigid(upper.side_nodes["y1"])
    m.traction(upper, "y1", (0.0, -FORCE / (2 * width)), ramp(0.0, 1.0))
    m.traction(upper, "y1", (share * FRICTION * FORCE / (2 * width), 0.0), ramp(1.0, 1.0 + steps))
    near = lambda p: abs(p[0]) < 2.0 * HALF
    sides = [(upper, "y0", near), (lower, "y1", near)]
    m.interface(*(sides if slave == "upper" else sides[::-1]))
    s = solve(m, family, friction=FRICTION, end=1.0 + steps, steps=1 + steps)
    p, q, u, area = s.pressure(), s.shear(), s.u(m.watched[0]), s.area()
    at = sorted((m.mesh.nodes[i][0] + u[i][0], p[i], abs(q[i][0])) for i in p)
    middle = min(at, key=lambda row: abs(row[0]))
    stick = HALF * math.sqrt(1 - share)
    form = lambda x: FRICTION * PEAK * (math.sqrt(max(0.0, 1 - x * x)) - (stick * math.sqrt(1 - (x / stick) ** 2) if abs(x) < stick else 0.0))
    return Outcome(s, {"stick half-width": 1 - middle[2] / (FRICTION * PEAK), "largest shear": max(row[2] for row in at) / (FRICTION * PEAK),
                       "shear force": abs(sum(q[i][0] * area[i] for i in p)) / (share * FRICTION * FORCE),
                       "above the bound": max((row[2] - FRICTION * row[1]) / (FRICTION * PEAK) for row in at)},
                   curves={"computed": [(x, t / (FRICTION * PEAK)) for x, _, t in at if abs(x) < 1.3],
                           "published": [(k / 50, form(k / 50) / (FRICTION * PEAK)) for k in range(-65, 66)]})


def stick_of(variant):
    return math.sqrt(1 - variant.get("share", 0.5))


def largest_of(variant):
    """Shear is largest at the edge of the stick zone, where it is μ p."""
    return math.sqrt(variant.get("share", 0.5))


CASE = Case(
    "Sheared cylinders (Cattaneo and Mindlin)", "C. Cattaneo 1938; R. D. Mindlin 1949; Johnson, Contact Mechanics, § 7.2", "ANALYTIC",
    "Half-planes of 40 half-widths here; tractions are steep at the edge of the stick zone, where the mesh smears them over a cell.",
    [Quantity("stick half-width", stick_of, (0.05, 0.03, 0.02)), Quantity("largest shear", largest_of, (0.15, 0.06, 0.03), scale=1.0),
     Quantity("shear force", 1.0, 2e-3, order=False), Quantity("above the bound", 0.0, 1e-3, scale=1.0, order=False)],
    (6, 12, 24), run, size=lambda n: 1 / n,
    variants={"T = 0.5 μP": {}, "T = 0.2 μP": {"share": 0.2}, "T = 0.8 μP": {"share": 0.8}, "one step": {"steps": 1}, "16 steps": {"steps": 16},
              "lower as slave": {"slave": "lower"}, "penalty": {"family": "penalty frictional"}, "micrometres": {"length": 1e6, "stress": 1e-12}},
    quick=["T = 0.5 μP"])
