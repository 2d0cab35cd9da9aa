"""A thin belt on a drum: its tension grows by exp(μ θ) where it slides."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model, ramp
from lib.solution import solve

YOUNG, RADIUS, THICK, ANGLE, TENSION = 1e5, 1.0, 0.02, math.pi / 2, 5.0


def run(n, family="ALM frictional", friction=0.3, slave="belt", steps=6, **units):
    m = Model(2, **units)
    turned = lambda r, t: (-r * math.sin(t), r * math.cos(t))  # from the top to the left
    drum = m.box("Drum", "2D4N", [1, n + n // 5], [0.9 * RADIUS, -0.1], [RADIUS, ANGLE + 0.1], turned)
    belt = m.box("Belt", "2D4N", [2, n], [RADIUS, 0.0], [RADIUS + THICK, ANGLE], turned, element="TotalLagrangianElement")
    for body in (drum, belt):
        m.material(body, "strain", YOUNG, 0.0)
    m.fix(drum.nodes, x=0.0, y=0.0)
    # the slack end, at the top, is pulled by a given tension; the other is drawn down
    m.traction(belt, "y0", (TENSION / THICK, 0.0), ramp(0.0, 1.0))
    m.fix(belt.side_nodes["y1"], x=None, y=f"-0.02*{ramp(1.0, float(steps))}")
    sides = [(belt, "x0"), (drum, "x1")]
    m.interface(*(sides if slave == "belt" else sides[::-1]))
    s = solve(m, family, friction=friction, end=float(steps), steps=steps)
    pull = -s.reaction(belt.side_nodes["y1"])[1]
    return Outcome(s, {"tension over tension": pull / TENSION})


CASE = Case(
    "Belt on a drum", "L. Euler, J. A. Eytelwein: T₂ = T₁ exp(μ θ)", "ANALYTIC",
    "The belt has a thickness of a fiftieth of the radius and bends, which Euler neglects; polygons transmit pressure through their corners.",
    [Quantity("tension over tension", lambda v: math.exp(v.get("friction", 0.3) * ANGLE), (0.04, 0.02, 0.01))],
    (40, 80), run, size=lambda n: 1 / n,
    variants={"μ = 0.3": {}, "μ = 0.1": {"friction": 0.1}, "μ = 0.8": {"friction": 0.8}, "drum as slave": {"slave": "drum"},
              "12 steps": {"steps": 12}, "penalty": {"family": "penalty frictional"}, "millimetres": {"length": 1e3, "stress": 1e-6}},
    known={"drum as slave": "a belt of two elements in its thickness as the master of a finer drum turns inside out on the fine mesh"}, quick=False)
