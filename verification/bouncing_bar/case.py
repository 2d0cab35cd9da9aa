"""A bar that bounces between two rigid walls twenty times."""
import math

from lib.case import Case, Outcome, Quantity
from lib.dynamics import Balance
from lib.model import Model
from lib.solution import solve

YOUNG, DENSITY, LENGTH, SPEED, GAP, TIMES = 100.0, 0.01, 10.0, 0.1, 0.01, 20
WAVE = math.sqrt(YOUNG / DENSITY)


def run(n, family="ALM", courant=1.0, dynamic=None):
    m, dt = Model(2), courant * LENGTH / n / WAVE
    bar = m.box("Bar", "2D4N", [n, 1], [GAP, 0.0], [GAP + LENGTH, 1.0], element="TotalLagrangianElement")
    walls = [m.box(name, "2D4N", [1, 3], [at, -0.2], [at + 1.0, 1.2]) for name, at in (("Left", -1.0), ("Right", LENGTH + 2 * GAP))]
    for body in (bar, *walls):
        m.material(body, "strain", YOUNG, 0.0, DENSITY=DENSITY)
    for wall in walls:
        m.fix(wall.nodes, x=0.0, y=0.0)
    m.roll(bar.nodes, y=0.0)
    m.velocity(bar.nodes, (-SPEED, 0.0))
    m.interface((bar, "x0"), (walls[0], "x1"))
    m.interface((bar, "x1"), (walls[1], "x0"))
    period = 2 * LENGTH / WAVE + 2 * GAP / SPEED
    end = math.ceil(TIMES * period / dt) * dt
    s = solve(m, family, time_step=dt, end=end, dynamic=dynamic or {}, variables=("DISPLACEMENT", "VELOCITY"))
    balance, start = Balance(m, [(bar, YOUNG, 0.0, DENSITY)]), 0.5 * DENSITY * LENGTH * SPEED ** 2
    history = [balance.of(s, k) for k in range(0, len(s.times), 2)]
    signs = [h[0] > 0 for h in history if abs(h[0]) > 0.5 * DENSITY * LENGTH * SPEED]
    return Outcome(s, {"largest energy": max(h[3] + h[4] for h in history) / start, "energy at the end": (history[-1][3] + history[-1][4]) / start,
                       "rebounds": sum(a != b for a, b in zip(signs, signs[1:]))},
                   curves={"computed": [(s.times[2 * k] / period, (h[3] + h[4]) / start) for k, h in enumerate(history)], "published": [(0.0, 1.0), (TIMES, 1.0)]},
                   labels=("energy over that at the start", "rebounds"))


CASE = Case(
    "Bar between two walls", "energy of a bar that bounces without loss; balance of energy", "ANALYTIC",
    "Energy is conserved. Rebounds are fewer than those of a rigid bar: the gap is as wide as the bar oscillates. The dispersed wave front "
    "of the mesh keeps oscillating, so the centre is slower or faster after each rebound.",
    [Quantity("largest energy", 1.0, 0.02, order=False), Quantity("energy at the end", 1.0, {"": 0.02, "double steps": 0.03}, order=False),
     Quantity("rebounds", TIMES, (0.5, 0.3), order=False)],
    (10, 20), run, size=lambda n: 1 / n,
    variants={"default scheme": {}, "half steps": {"courant": 0.5}, "double steps": {"courant": 2.0}, "newmark": {"dynamic": {"scheme_type": "newmark"}}},
    known={"newmark": "energy stays, and a share of it swings in the bar for good: nothing damps the waves that cells do not resolve"}, quick=False, slow=True)
