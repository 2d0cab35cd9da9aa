"""Two cylinders pressed together, from small contacts to wide ones."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.shapes import bulge, edge_of_contact, scaled, stations
from lib.solution import solve

YOUNG, POISSON, HALF = 1e3, 0.3, 1.0  # lengths in half-widths of contact
MODULUS = YOUNG / (2 * (1 - POISSON ** 2))


def run(n, ratio=0.002, family="ALM", slave="upper", steps=1, friction=None, shape="2D4N", **units):
    """`ratio` is that of half-width and radius."""
    radius = HALF / ratio
    force = math.pi * HALF ** 2 * MODULUS / (4 * (radius / 2))
    peak = 2 * force / (math.pi * HALF)
    width, arc = 40.0 * HALF, min(3.0 * HALF, 0.6 * radius)
    m, bodies = Model(2, **units), []
    for name, sign, size in (("Lower", -1, 1.0 / n), ("Upper", 1, 0.9 / n)):
        s = scaled(stations(size, 0.0, width))
        s = s if sign > 0 else [1.0 - v for v in reversed(s)]
        bodies.append(m.graded(name, shape, [stations(size, 1.5, width), s], bulge(radius, arc, width, sign)))
        m.material(bodies[-1], "strain", YOUNG, POISSON)
    lower, upper = bodies
    m.roll(lower.side_nodes["x0"] + upper.side_nodes["x0"], x=0.0)
    m.roll(lower.side_nodes["y0"], y=0.0)
    m.traction(upper, "y1", (0.0, -force / (2 * width)))
    near = lambda p: abs(p[0]) < 3.0 * HALF
    sides = [(upper, "y0", near), (lower, "y1", near)]
    m.interface(*(sides if slave == "upper" else sides[::-1]))
    s = solve(m, family, steps=steps, friction=friction)
    p, u = s.pressure(), s.u(m.watched[0])
    at = sorted((m.mesh.nodes[i][0] + u[i][0], p[i]) for i in p)
    half, top = edge_of_contact(at)
    return Outcome(s, {"half-width": half / HALF, "peak pressure": top / peak},
                   curves={"computed": [(x, q / peak) for x, q in at if x < 1.4],
                           "published": [(k / 50, math.sqrt(max(0.0, 1 - (k / 50) ** 2))) for k in range(71)]})


CASE = Case(
    "Two cylinders (Hertz)", "H. Hertz 1882; Johnson, Contact Mechanics, § 4.2", "ANALYTIC",
    "Values are relative to Hertz'. Half-planes are 40 half-widths deep and wide here; Hertz' parabola and vanishing strain hold as a/R goes "
    "to 0, and an offset of the order of a/R times the strain p₀/E stays beyond.",
    [Quantity("half-width", 1.0, {"": (0.02, 0.005, 0.004), "a/R = 0.2": 0.07, "a/R = 0.1": 0.035, "a/R = 0.02": (0.02, 0.012)}),
     Quantity("peak pressure", 1.0, {"": (0.01, 0.005, 0.005), "a/R = 0.2": 0.07, "a/R = 0.1": 0.035, "a/R = 0.02": (0.02, 0.012)})],
    (6, 12, 24), run, size=lambda n: 1 / n,
    variants={"a/R = 0.2": {"ratio": 0.2}, "a/R = 0.1": {"ratio": 0.1}, "a/R = 0.02": {"ratio": 0.02}, "a/R = 0.002": {},
              "a/R = 1e-5": {"ratio": 1e-5}, "lower as slave": {"slave": "lower"}, "components": {"family": "ALM components"},
              "penalty": {"family": "penalty"}, "Uzawa": {"family": "Uzawa"}, "perturbed": {"family": "perturbed"},
              "4 steps": {"steps": 4}, "2D6N": {"shape": "2D6N"}, "2D8N": {"shape": "2D8N"}, "2D9N": {"shape": "2D9N"}, "frictional": {"family": "ALM frictional", "friction": 0.2},
              "micrometres": {"length": 1e6, "stress": 1e-12}},
    picture="a/R = 0.002", quick=["a/R = 0.002", "2D8N"])
