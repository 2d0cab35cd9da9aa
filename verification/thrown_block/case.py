"""A block thrown at the ground, turned, rebounds and spins: nothing comes from nothing."""
import math

from lib.case import Case, Outcome, Quantity
from lib.dynamics import Balance
from lib.model import Model
from lib.solution import solve

YOUNG, POISSON, DENSITY, SPEED = 1e3, 0.2, 0.01, (3.0, -4.0)


def run(n, family="ALM", degrees=12.0, steps=160, dynamic=None, slave="block"):
    m, angle = Model(2), math.radians(degrees)
    c, s_ = math.cos(angle), math.sin(angle)
    low = min(x * s_ + y * c for x in (-0.5, 0.5) for y in (-0.5, 0.5))
    block = m.box("Block", "2D4N", [n, n], [-0.5, -0.5], [0.5, 0.5], lambda x, y: (x * c - y * s_, x * s_ + y * c - low + 0.1), element="TotalLagrangianElement")
    ground = m.box("Ground", "2D4N", [12, 1], [-2.0, -0.5], [4.0, 0.0])
    for body in (block, ground):
        m.material(body, "strain", YOUNG, POISSON, DENSITY=DENSITY)
    m.fix(ground.nodes, x=0.0, y=0.0)
    m.velocity(block.nodes, SPEED)
    skin = [c_ for side in ("x0", "x1", "y0", "y1") for c_ in block.conditions(side, "Line")]  # all of it may touch
    m.between(*((skin, ground.conditions("y1", "Line")) if slave == "block" else (ground.conditions("y1", "Line"), skin)))
    end = 0.4
    s = solve(m, family, time_step=end / steps, end=end, dynamic=dynamic or {}, variables=("DISPLACEMENT", "VELOCITY"))
    balance = Balance(m, [(block, YOUNG, POISSON, DENSITY)])
    history = [balance.of(s, k) for k in range(len(s.times))]
    start = 0.5 * DENSITY * (SPEED[0] ** 2 + SPEED[1] ** 2)
    return Outcome(s, {"momentum along the ground": max(abs(h[0] / (DENSITY * SPEED[0]) - 1.0) for h in history),
                       "largest energy": max(h[3] + h[4] for h in history) / start, "energy after": (history[-1][3] + history[-1][4]) / start,
                       "leaves the ground": 1.0 if history[-1][1] > 0 else 0.0})


CASE = Case(
    "Thrown block", "balance of momentum and energy: without friction the momentum along the ground stays", "ANALYTIC",
    "Momentum obeys the law to the tolerance of the iteration (1e-4); energy is conserved except for the damping of the scheme and the error of a step in which contact opens.",
    [Quantity("momentum along the ground", 0.0, 1e-3, scale=1.0, order=False), Quantity("largest energy", 1.0, 0.02, order=False),
     Quantity("energy after", 1.0, 0.02, order=False), Quantity("leaves the ground", 1.0, 0.0, order=False)],
    (4, 8), run, size=lambda n: 1 / n,
    variants={"default scheme": {}, "flat": {"degrees": 0.0}, "320 steps": {"steps": 320}, "newmark": {"dynamic": {"scheme_type": "newmark"}},
              "40 steps": {"steps": 40}, "ground as slave": {"slave": "ground"}, "flat, ground as slave": {"degrees": 0.0, "slave": "ground"}},
    known={"40 steps": "on the coarse mesh one step, that to time 0.07 in which contact closes for the second time, loses 11 % of the energy; the cause is not known",
           "ground as slave": "the corner of a master between two nodes of a slave twice as coarse: their weighted gaps stay open while it goes in, and the program refuses the energy this makes; the finer side is the slave"},
    quick=False)
