"""A ring in flight hits another at rest off its centre: momentum, angular momentum and energy."""
import math

from lib.case import Case, Outcome, Quantity
from lib.dynamics import Balance
from lib.model import Model
from lib.shapes import polar
from lib.solution import solve

YOUNG, POISSON, DENSITY, INNER, OUTER, SPEED = 100.0, 0.2, 0.01, 8.0, 10.0, 2.0


def run(n, family="ALM", dynamic=None, steps=100, offset=4.0):
    m, bodies = Model(2), []
    for name, x, y, count in (("Left", -10.3, 0.0, 4 * n), ("Right", 10.3, offset, 4 * n + 4)):
        at = lambda r, t, x=x, y=y: (x + polar(r, t)[0], y + polar(r, t)[1])
        body = m.box(name, "2D4N", [2, count], [INNER, 0.0], [OUTER, 2 * math.pi], at, wrap="y", element="TotalLagrangianElement")
        m.material(body, "strain", YOUNG, POISSON, DENSITY=DENSITY)
        bodies.append(body)
    left, right = bodies
    m.velocity(left.nodes, (SPEED, 0.0))
    m.interface((left, "x1"), (right, "x1"))
    end = 20.0
    s = solve(m, family, time_step=end / steps, end=end, dynamic=dynamic or {}, variables=("DISPLACEMENT", "VELOCITY"))
    balance = Balance(m, [(b, YOUNG, POISSON, DENSITY) for b in bodies])
    history = [balance.of(s, k) for k in range(len(s.times))]
    mass = sum(det * density for _, _, _, det, _, _, density in Balance(m, [(left, YOUNG, POISSON, DENSITY)]).points)
    p0, e0 = mass * SPEED, 0.5 * mass * SPEED ** 2
    energy = [h[3] + h[4] for h in history]
    other = Balance(m, [(right, YOUNG, POISSON, DENSITY)]).of(s, -1)
    return Outcome(s, {"momentum": max(math.hypot(h[0] / p0 - 1.0, h[1] / p0) for h in history),
                       "angular momentum": max(abs(h[2] - history[0][2]) for h in history) / (p0 * OUTER),
                       "largest energy": max(energy) / e0, "energy after": energy[-1] / e0, "share passed on": other[0] / p0})


CASE = Case(
    "Two rings collide", "balance of momentum, angular momentum and energy (after Wriggers, Vu Van and Stein 1990; Hesch and Betsch 2011)",
    "ANALYTIC", "Momentum is conserved exactly; energy may only decrease, by the damping of the scheme.",
    [Quantity("momentum", 0.0, 1e-6, scale=1.0, order=False), Quantity("angular momentum", 0.0, 1e-2, scale=1.0, order=False),
     Quantity("largest energy", 1.0, 0.02, order=False), Quantity("energy after", 1.0, {"": 0.05, "bossak": 0.2}, order=False)],
    (10, 16), run, size=lambda n: 1 / n,
    variants={"default scheme": {}, "200 steps": {"steps": 200}, "newmark": {"dynamic": {"scheme_type": "newmark"}},
              "bossak": {"dynamic": {"scheme_type": "bossak"}}, "head on": {"offset": 0.0}},
    quick=False)
