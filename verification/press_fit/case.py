"""A ring shrunk on another: quarter rings whose meshes overlap by the interference."""
import math

from lib.case import Case, Outcome, Quantity
from lib.measures import lame, mean, rms
from lib.model import FRICTIONLESS, Model
from lib.shapes import polar
from lib.solution import solve

INNER, MIDDLE, OUTER, FIT = 1.0, 2.0, 3.0, 1e-2
SOFT, HARD = (1e5, 0.3), (2e5, 0.3)
PAIRS, STRESS = lame([(INNER, MIDDLE, *SOFT, FIT), (MIDDLE, OUTER, *HARD)], ("pressure", 0.0), ("pressure", 0.0))


def run(n, family="ALM", slave="inner", friction=None, steps=1, ratio=(3, 2), **units):
    m = Model(2, **units)
    bodies = []
    for name, r0, r1, count, material in (("Inner", INNER, MIDDLE, n * ratio[0], SOFT), ("Outer", MIDDLE - FIT, OUTER, n * ratio[1], HARD)):
        body = m.box(name, "2D4N", [n, count], [r0, 0.0], [r1, math.pi / 2], polar)
        m.material(body, "strain", *material)
        m.roll(body.side_nodes["y0"], y=0.0)
        m.roll(body.side_nodes["y1"], x=0.0)
        bodies.append(body)
    sides = [(bodies[0], "x1"), (bodies[1], "x0")]
    m.interface(*(sides if slave == "inner" else sides[::-1]))
    s = solve(m, family, friction=friction, steps=steps)

    def widening(body, side):
        ids = body.side_nodes[side]
        u, at = s.u(ids), s.at(ids)
        return mean((u[i][0] * at[i][0] + u[i][1] * at[i][1]) / math.hypot(*at[i]) for i in ids)
    values = {"widening of the rim": widening(bodies[1], "x1"), "narrowing of the bore": widening(bodies[0], "x0")}
    if not family.startswith("MPC"):
        p, area = s.pressure(), s.area()
        values["pressure"] = sum(p[i] * area[i] for i in p) / sum(area[i] for i in p)
        values["scatter of the pressure"] = rms(v / values["pressure"] - 1.0 for v in p.values()) if values["pressure"] else math.inf
    return Outcome(s, values)


def at(k, r):
    a, b = PAIRS[k]
    return a * r + b / r


CASE = Case(
    "Press fit (Lamé)", "G. Lamé 1852; Timoshenko and Goodier, Theory of Elasticity, § 28", "ANALYTIC",
    "The facets of non-matching polygons overlap by the interference and their sagittas, of the order of the mesh size squared over the "
    "interference. The interference itself is half a hundredth of the radius, which Lamé neglects.",
    [Quantity("pressure", -STRESS(0, MIDDLE), (0.2, 0.06, 0.02)), Quantity("widening of the rim", at(1, OUTER), (0.2, 0.06, 0.02)),
     Quantity("narrowing of the bore", at(0, INNER), (0.2, 0.06, 0.02)), Quantity("scatter of the pressure", 0.0, (1.2, 0.8, 0.4), scale=1.0)],
    (8, 16, 32), run, size=lambda n: 1 / n,
    variants={**{f: {"family": f} for f in FRICTIONLESS}, "outer as slave": {"slave": "outer"}, "like meshes": {"ratio": (2, 2)},
              "frictional": {"family": "ALM frictional", "friction": 0.2}, "4 steps": {"steps": 4}, "millimetres": {"length": 1e3, "stress": 1e-6}},
    picture="ALM", quick=["ALM"])
