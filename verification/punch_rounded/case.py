"""A rigid punch, flat with rounded edges, on a half-plane."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import FRICTIONLESS, Model
from lib.shapes import scaled, stations
from lib.solution import solve

YOUNG, POISSON, FLAT, EDGE, RADIUS = 1e3, 0.3, 1.0, 1.25, 50.0  # half-widths of the flat and of contact, radius of the edges
MODULUS, PHI = YOUNG / (1 - POISSON ** 2), math.asin(FLAT / EDGE)
FORCE = MODULUS * EDGE ** 2 / (2 * RADIUS) * ((math.pi / 2 - PHI) - 0.5 * math.sin(2 * PHI))


def pressure(x):
    """Ciavarella, Hills and Monno's closed form."""
    if abs(x) >= EDGE:
        return 0.0
    f = math.asin(x / EDGE)
    if abs(abs(f) - PHI) < 1e-9:
        f += 1e-7
    inner = (abs(math.sin(f + PHI) / math.sin(f - PHI)) ** math.sin(f)
             * abs(math.tan((f + PHI) / 2) * math.tan((f - PHI) / 2)) ** math.sin(PHI))
    return FORCE / EDGE * (2 / math.pi) / (math.pi - 2 * PHI - math.sin(2 * PHI)) * ((math.pi - 2 * PHI) * math.cos(f) + math.log(inner))


def run(n, family="ALM", slave="plane", steps=1, **units):
    m, size, width = Model(2, **units), 1.0 / n, 60.0
    profile = lambda x: max(0.0, abs(x) - FLAT) ** 2 / (2 * RADIUS)
    xs = stations(size, 1.6, width)
    plane = m.graded("Plane", "2D4N", [xs, [-y for y in reversed(stations(size, 0.0, width))]])
    wide = stations(0.9 * size, 1.6, 2.5)
    punch = m.graded("Punch", "2D4N", [wide, scaled(stations(3 * size, 0.0, 1.0))], lambda x, s: (x, profile(x) + s * (1.0 - profile(x))))
    m.material(plane, "strain", YOUNG, POISSON)
    m.material(punch, "strain", 1e4 * YOUNG, 0.0)
    m.roll(plane.side_nodes["x0"] + punch.side_nodes["x0"], x=0.0)
    m.roll(plane.side_nodes["y0"], y=0.0)
    m.traction(punch, "y1", (0.0, -FORCE / 2 / 2.5))
    near = lambda p: abs(p[0]) < 2.5
    sides = [(plane, "y1", near), (punch, "y0")]
    m.interface(*(sides if slave == "plane" else sides[::-1]))
    s = solve(m, family, steps=steps)
    p, u, area = s.pressure(), s.u(m.watched[0]), s.area()
    at = sorted((m.mesh.nodes[i][0] + u[i][0], p[i]) for i in p)
    load = sum(p[i] * area[i] for i in p)
    # the edge from the second moment, which the closed form has too: it needs no fit
    second = sum(p[i] * area[i] * (m.mesh.nodes[i][0] + u[i][0]) ** 2 for i in p) / load
    centre = min(at)[1]
    peak = max(q for _, q in at)
    return Outcome(s, {"pressure at the centre": centre, "radius of gyration of the pressure": math.sqrt(second), "load": 2 * load},
                   curves={"computed": [q for q in at if q[0] < 1.6], "published": [(k / 100, pressure(k / 100)) for k in range(161)]})


def moment():
    steps = 20000
    values = [(EDGE * (k + 0.5) / steps, pressure(EDGE * (k + 0.5) / steps)) for k in range(steps)]
    return math.sqrt(sum(x * x * p for x, p in values) / sum(p for _, p in values))


CASE = Case(
    "Punch with rounded edges", "M. Ciavarella, D. A. Hills, G. Monno, The influence of rounded edges on indentation by a flat punch, "
    "Proc. IMechE C 212 (1998); the plane form of NAFEMS R0094, benchmark 2", "ANALYTIC",
    "The half-plane is 48 half-widths deep here and strains are 1 %; the peaks at the ends of the flat are logarithmically steep.",
    [Quantity("pressure at the centre", pressure(0.0), (0.02, 0.01, 0.01)),
     Quantity("radius of gyration of the pressure", moment(), (0.02, 0.01, 0.005)), Quantity("load", FORCE, 2e-3, order=False)],
    (8, 16, 32), run, size=lambda n: 1 / n,
    variants={**{f: {"family": f} for f in FRICTIONLESS if f != "MPC"}, "punch as slave": {"slave": "punch"}, "4 steps": {"steps": 4},
              "millimetres": {"length": 1e3, "stress": 1e-6}}, quick=["ALM"])
