"""A round die pressed into a slab and drawn along it."""
import math

from lib.case import Case, Outcome, Quantity
from lib.measures import mean
from lib.model import Model, ramp
from lib.shapes import mirrored, scaled, stations
from lib.solution import solve

YOUNG, POISSON, RADIUS, DEPTH, WAY = 1e3, 0.3, 2.0, 0.05, 1.0


def run(n, family="ALM", slave="die", friction=None, steps=10, **units):
    """Pressed in one step, drawn in `steps`; forces are those over the drawing, from a third of the way on."""
    m = Model(2, **units)
    slab = m.box("Slab", "2D4N", [6 * n, 2 * n], [0.0, 0.0], [6.0, 1.0])
    low = lambda x: RADIUS - math.sqrt(RADIUS ** 2 - x * x)
    die = m.graded("Die", "2D4N", [mirrored(stations(0.7 / n, 0.8, 1.2)), scaled(stations(1.0 / n, 0.0, 1.0))],
                   lambda x, s: (2.5 + x, 1.0 + low(x) + s * (1.0 - low(x))))
    m.material(slab, "strain", YOUNG, POISSON)
    m.material(die, "strain", 1e3 * YOUNG, POISSON)
    m.fix(slab.side_nodes["y0"], x=0.0, y=0.0)
    m.fix(die.side_nodes["y1"], x=f"{WAY!r}*{ramp(1.0, 1.0 + steps)}", y=f"{-DEPTH!r}*{ramp(0.0, 1.0)}")
    sides = [(die, "y0"), (slab, "y1")]
    m.interface(*(sides if slave == "die" else sides[::-1]))
    s = solve(m, family, friction=friction, end=1.0 + steps, steps=1 + steps)
    held = slab.side_nodes["y0"]
    forces = [s.reaction(held, k) for k in range(len(s.times))]
    drawn = forces[1 + steps // 3:]
    ratio = mean(-f[0] / f[1] for f in drawn)
    up = [f[1] for f in drawn]
    values = {"drag over pressing force": ratio, "scatter of the pressing force": (max(up) - min(up)) / mean(up)}
    return Outcome(s, values, curves={"computed": [(t, -f[0] / f[1]) for t, f in zip(s.times, forces)],
                                      "published": [(1.0, friction or 0.0), (1.0 + steps, friction or 0.0)]}, labels=("drag over pressing force", "step"))


FINE = {"family": "ALM frictional", "friction": 0.3}
CASE = Case(
    "Ironing", "balance and translation: without friction there is no drag, with friction drag is μ times the pressing force, and nothing changes "
    "along the way (after Fischer and Wriggers 2006)", "ANALYTIC",
    "A long slab under a die pressed in by a twentieth of its height; facets pass under facets, whose ripple falls with the mesh. Drag through friction "
    "tilts the die slightly forwards.",
    [Quantity("drag over pressing force", lambda v: v.get("friction", 0.0) or 0.0, (0.05, 0.02, 0.01), scale=1.0, order=False),
     Quantity("scatter of the pressing force", 0.0, (0.3, 0.1, 0.05), scale=1.0)],
    (5, 10, 20), run, size=lambda n: 1 / n,
    variants={"frictionless": {}, "30 steps": {"steps": 30}, "slab as slave": {"slave": "slab"}, "μ = 0.3": FINE, "μ = 0.3, slab as slave": {**FINE, "slave": "slab"},
              "μ = 0.3, 30 steps": {**FINE, "steps": 30}, "penalty": {"family": "penalty"}, "μ = 0.3, penalty": {"family": "penalty frictional", "friction": 0.3},
              "millimetres": {"length": 1e3, "stress": 1e-6}}, quick=False)
