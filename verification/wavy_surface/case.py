"""A wavy surface pressed on a rigid plane: contact grows from the crests (a problem of Signorini's kind with a closed form)."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import FRICTIONLESS, Model
from lib.shapes import stations
from lib.solution import solve

YOUNG, POISSON, WAVE, HEIGHT = 1e3, 0.3, 2.0, 0.002  # wave length, amplitude
FULL = math.pi * YOUNG / (1 - POISSON ** 2) * HEIGHT / WAVE  # mean pressure that closes the surface
HALF = 0.3  # half-width of contact over the wave length is half of this
MEAN = FULL * math.sin(math.pi * HALF / WAVE) ** 2


def pressure(x):
    psi, a = math.pi * x / WAVE, math.pi * HALF / WAVE
    inside = math.sin(a) ** 2 - math.sin(psi) ** 2
    return 2 * MEAN * math.cos(psi) / math.sin(a) ** 2 * math.sqrt(inside) if inside > 0 else 0.0


def run(n, family="ALM", slave="wave", **units):
    m, depth = Model(2, **units), 2 * WAVE
    crest = lambda x, y: (x, y + (1 - y / depth) * HEIGHT * (1 - math.cos(2 * math.pi * x / WAVE)))
    xs = [WAVE / 2 * i / n for i in range(n + 1)]
    body = m.graded("Wave", "2D4N", [xs, stations(WAVE / 2 / n, 0.0, depth, 1.15)], crest)
    ground = m.box("Ground", "2D4N", [n - n // 4, 1], [-0.1, -0.2], [WAVE / 2 + 0.1, 0.0])
    for b in (body, ground):
        m.material(b, "strain", YOUNG, POISSON)
    m.fix(ground.nodes, x=0.0, y=0.0)
    m.roll(body.side_nodes["x0"] + body.side_nodes["x1"], x=0.0)
    m.traction(body, "y1", (0.0, -MEAN))
    sides = [(body, "y0"), (ground, "y1")]
    m.interface(*(sides if slave == "wave" else sides[::-1]))
    s = solve(m, family)
    p, u = s.pressure(), s.u(m.watched[0])
    at = sorted((m.mesh.nodes[i][0] + u[i][0], p[i]) for i in p)
    area = s.area()
    sin2 = [(math.sin(math.pi * x / WAVE) ** 2, (q / math.cos(math.pi * x / WAVE)) ** 2) for x, q in at if q > max(v for _, v in at) / 3]
    mx, my = sum(a for a, _ in sin2) / len(sin2), sum(b for _, b in sin2) / len(sin2)
    slope = sum((a - mx) * (b - my) for a, b in sin2) / sum((a - mx) ** 2 for a, _ in sin2)
    edge = WAVE / math.pi * math.asin(math.sqrt(mx - my / slope))
    crest_pressure = math.sqrt(my - slope * mx)
    return Outcome(s, {"half-width": edge, "crest pressure": crest_pressure, "load": sum(p[i] * area[i] for i in p)},
                   curves={"computed": at, "published": [(WAVE / 2 * k / 80, pressure(WAVE / 2 * k / 80)) for k in range(81)]})


CASE = Case(
    "Wavy surface on a rigid plane", "H. M. Westergaard, Bearing pressures and cracks, J. Appl. Mech. 6 (1939); Johnson, Contact Mechanics, § 13.2",
    "ANALYTIC", "Half-plane with a wave 0.1 % high; pressure is steep at the edge of contact, which a mesh resolves to its size.",
    [Quantity("half-width", HALF, (0.03, 0.015, 0.01)), Quantity("crest pressure", pressure(0.0), (0.02, 0.01, 0.005)),
     Quantity("load", MEAN * WAVE / 2, 1e-3, order=False)],
    (20, 40, 80), run, size=lambda n: 1 / n, variants={**{f: {"family": f} for f in FRICTIONLESS if f != "MPC"},
              "millimetres": {"length": 1e3, "stress": 1e-6}}, quick=["ALM"])
