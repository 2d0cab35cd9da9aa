"""A sleeve shrunk on a shaft and pulled along it: axisymmetric friction under Lamé's pressure."""
import math

from lib.case import Case, Outcome, Quantity
from lib.measures import lame
from lib.model import Model, ramp
from lib.solution import solve

HOLE, SHAFT, OUTSIDE, LENGTH, FIT, YOUNG, FRICTION, PULL = 0.2, 1.0, 1.5, 2.0, 2e-3, 1e5, 0.2, 4e-3
PRESSURE = -lame([(HOLE, SHAFT, YOUNG, 0.0, FIT), (SHAFT, OUTSIDE, YOUNG, 0.0)], ("pressure", 0.0), ("pressure", 0.0))[1](0, SHAFT)


def run(n, family="ALM frictional", slave="sleeve", steps=4, way=1.0, **units):
    m, kind = Model(2, **units), {"element": "AxisymSmallDisplacementElement"}
    shaft = m.box("Shaft", "2D4N", [n, 3 * n], [HOLE, 0.0], [SHAFT, LENGTH], **kind)
    sleeve = m.box("Sleeve", "2D4N", [n, 4 * n], [SHAFT - FIT, 0.0], [OUTSIDE, LENGTH], **kind)
    for body in (shaft, sleeve):
        m.material(body, "axis", YOUNG, 0.0)
    m.roll(shaft.side_nodes["x0"], y=0.0)
    m.roll(sleeve.side_nodes["x1"], y=f"{way * PULL!r}*{ramp(1.0, float(steps))}")
    sides = [(sleeve, "x0"), (shaft, "x1")]
    m.interface(*(sides if slave == "sleeve" else sides[::-1]))
    s = solve(m, family, friction=FRICTION, end=float(steps), steps=steps, contact={"alternative_formulations": {"axisymmetric": True}})
    first = s.pressure(step=0)
    middle = [p for i, p in first.items() if abs(m.mesh.nodes[i][1] - LENGTH / 2) < 0.3 * LENGTH]
    force = s.reaction(sleeve.side_nodes["x1"])[1]
    return Outcome(s, {"pressure": sum(middle) / len(middle), "force to pull": force})


CASE = Case(
    "Sleeve pulled along a shaft", "Lamé's pressure of the interference, Coulomb's law on 2π r L", "ANALYTIC",
    "Poisson's ratio is 0, so that the pressure is uniform along the shaft; the sleeve has moved by 0.2 % of its length, and strains are 0.2 %.",
    [Quantity("pressure", PRESSURE, (0.02, 0.01, 0.005)),
     Quantity("force to pull", lambda v: math.copysign(FRICTION * PRESSURE * 2 * math.pi * SHAFT * LENGTH, v.get("way", 1.0)), (0.02, 0.015, 0.01))],
    (4, 8, 16), run, size=lambda n: 1 / n,
    variants={"ALM": {}, "the other way": {"way": -1.0}, "shaft as slave": {"slave": "shaft"}, "8 steps": {"steps": 8},
              "penalty": {"family": "penalty frictional"}, "millimetres": {"length": 1e3, "stress": 1e-6}}, quick=["ALM"])
