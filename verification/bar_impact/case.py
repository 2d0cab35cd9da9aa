"""A bar that flies against a rigid wall and rebounds."""
import math

from lib.case import Case, Outcome, Quantity
from lib.dynamics import Balance
from lib.model import Model
from lib.solution import solve

YOUNG, DENSITY, LENGTH, HIGH, SPEED, GAP = 100.0, 0.01, 10.0, 1.0, 0.1, 0.005
WAVE = math.sqrt(YOUNG / DENSITY)
TOUCH, TIME = GAP / SPEED, 2 * LENGTH / WAVE


def run(n, family="ALM", courant=1.0, slave="bar", dynamic=None, elastic_wall=False):
    """`courant` cells a step."""
    m, dt = Model(2), courant * LENGTH / n / WAVE
    bar = m.box("Bar", "2D4N", [n, 1], [GAP, 0.0], [GAP + LENGTH, HIGH], element="TotalLagrangianElement")
    wall = m.box("Wall", "2D4N", [1, 3], [-1.0, -0.2], [0.0, HIGH + 0.2])
    m.material(bar, "strain", YOUNG, 0.0, DENSITY=DENSITY)
    m.material(wall, "strain", YOUNG, 0.0, DENSITY=DENSITY)
    m.fix(wall.nodes, x=0.0, y=0.0)
    m.roll(bar.nodes, y=0.0)
    m.velocity(bar.nodes, (-SPEED, 0.0))
    sides = [(bar, "x0"), (wall, "x1")]
    m.interface(*(sides if slave == "bar" else sides[::-1]))
    end = math.ceil((TOUCH + 1.6 * TIME) / dt) * dt
    s = solve(m, family, time_step=dt, end=end, dynamic=dynamic or {}, variables=("DISPLACEMENT", "REACTION", "VELOCITY"))
    balance = Balance(m, [(bar, YOUNG, 0.0, DENSITY)])
    history = [balance.of(s, k) for k in range(len(s.times))]
    total = DENSITY * LENGTH * HIGH
    start = 0.5 * total * SPEED ** 2
    force = [s.reaction(wall.nodes, k)[0] for k in range(len(s.times))]
    rebound = history[-1][0] / total
    # the impulse is that of a constant force: its middle is half the contact time after the touch
    impulse = sum(force) * dt
    middle = sum(f * t for f, t in zip(force, s.times)) * dt / impulse if impulse else 0.0
    return Outcome(s, {"velocity after": rebound / SPEED, "largest energy": max(h[3] + h[4] for h in history) / start,
                       "energy after": (history[-1][3] + history[-1][4]) / start,
                       "time of contact": 2 * (middle - TOUCH) / TIME, "mean force": impulse / TIME / (DENSITY * WAVE * SPEED * HIGH)},
                   curves={"computed": [(t / TIME, f / (DENSITY * WAVE * SPEED * HIGH)) for t, f in zip(s.times, force)],
                           "published": [(0.0, 0.0), (TOUCH / TIME, 0.0), (TOUCH / TIME, 1.0), (TOUCH / TIME + 1, 1.0), (TOUCH / TIME + 1, 0.0), (TOUCH / TIME + 1.6, 0.0)]},
                   labels=("force on the wall over ρcvA", "time over 2L/c"))


CASE = Case(
    "Bar against a wall", "one-dimensional waves: contact lasts 2L/c under the force ρ c v A, and the bar leaves with its speed "
    "(Carpenter, Taylor and Katona 1991; Doyen, Ern and Piperno 2011)", "ANALYTIC",
    "The front of the wave is smeared over some cells and steps, so that a share of the energy, which falls with the mesh, remains as vibration of the bar; `bossak` damps it.",
    [Quantity("velocity after", 1.0, {"": (0.06, 0.04), "double steps": (0.1, 0.06)}), Quantity("largest energy", 1.0, 0.02, order=False),
     Quantity("energy after", 1.0, {"": 0.01, "bossak": (0.08, 0.05)}, order=False), Quantity("time of contact", 1.0, {"": (0.05, 0.03)}), Quantity("mean force", 1.0, {"": (0.04, 0.025), "double steps": (0.05, 0.035)})],
    (20, 40), run, size=lambda n: 1 / n,
    variants={"default scheme": {}, "quarter steps": {"courant": 0.25}, "double steps": {"courant": 2.0}, "wall as slave": {"slave": "wall"},
              "newmark": {"dynamic": {"scheme_type": "newmark"}}, "newmark, quarter steps": {"courant": 0.25, "dynamic": {"scheme_type": "newmark"}},
              "bossak": {"dynamic": {"scheme_type": "bossak"}}, "penalty": {"family": "penalty"},
              "components": {"family": "ALM components"}}, quick=False)
