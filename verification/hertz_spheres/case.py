"""Two spheres pressed together, in their meridional plane."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.shapes import bulge, edge_of_contact, scaled, stations
from lib.solution import solve

YOUNG, POISSON, HALF = 1e3, 0.3, 1.0
MODULUS = YOUNG / (2 * (1 - POISSON ** 2))


def run(n, ratio=0.002, family="ALM", slave="upper", steps=1, shape="2D4N", **units):
    radius = HALF / ratio
    force = 4 * MODULUS * HALF ** 3 / (3 * (radius / 2))
    peak = 3 * force / (2 * math.pi * HALF ** 2)
    width, arc = 25.0 * HALF, min(3.0 * HALF, 0.6 * radius)
    m, bodies = Model(2, **units), []
    for name, sign, size in (("Lower", -1, 1.0 / n), ("Upper", 1, 0.9 / n)):
        s = scaled(stations(size, 0.0, width))
        s = s if sign > 0 else [1.0 - v for v in reversed(s)]
        bodies.append(m.graded(name, shape, [stations(size, 1.5, width), s], bulge(radius, arc, width, sign),
                               element="AxisymSmallDisplacementElement"))
        m.material(bodies[-1], "axis", YOUNG, POISSON)
    lower, upper = bodies
    m.roll(lower.side_nodes["x0"] + upper.side_nodes["x0"], x=0.0)
    m.roll(lower.side_nodes["y0"], y=0.0)
    m.traction(upper, "y1", (0.0, -force / (math.pi * width ** 2)))
    near = lambda p: abs(p[0]) < 3.0 * HALF
    sides = [(upper, "y0", near), (lower, "y1", near)]
    m.interface(*(sides if slave == "upper" else sides[::-1]))
    s = solve(m, family, steps=steps, contact={"alternative_formulations": {"axisymmetric": True}})
    p, u = s.pressure(), s.u(m.watched[0])
    at = sorted((m.mesh.nodes[i][0] + u[i][0], p[i]) for i in p)
    half, top = edge_of_contact(at[1:])
    return Outcome(s, {"contact radius": half / HALF, "peak pressure": top / peak},
                   curves={"computed": [(x, q / peak) for x, q in at if x < 1.4],
                           "published": [(k / 50, math.sqrt(max(0.0, 1 - (k / 50) ** 2))) for k in range(71)]})


CASE = Case(
    "Two spheres (Hertz)", "H. Hertz 1882; Johnson, Contact Mechanics, § 4.2", "ANALYTIC",
    "Values are relative to Hertz'. Half-spaces are 25 contact radii deep and wide here; the peak is that of a fit without the axis node.",
    [Quantity("contact radius", 1.0, {"": (0.03, 0.01, 0.005), "a/R = 0.1": 0.04, "a/R = 0.02": (0.03, 0.012)}),
     Quantity("peak pressure", 1.0, {"": (0.02, 0.01, 0.005), "a/R = 0.1": 0.04, "a/R = 0.02": (0.03, 0.012)})],
    (6, 12, 24), run, size=lambda n: 1 / n,
    variants={"a/R = 0.1": {"ratio": 0.1}, "a/R = 0.02": {"ratio": 0.02}, "a/R = 0.002": {}, "a/R = 1e-5": {"ratio": 1e-5},
              "lower as slave": {"slave": "lower"}, "components": {"family": "ALM components"}, "penalty": {"family": "penalty"},
              "2D6N": {"shape": "2D6N"}, "2D8N": {"shape": "2D8N"}, "2D9N": {"shape": "2D9N"},
              "Uzawa": {"family": "Uzawa"}, "perturbed": {"family": "perturbed"}, "micrometres": {"length": 1e6, "stress": 1e-12}},
    picture="a/R = 0.002", quick=["a/R = 0.002"])
