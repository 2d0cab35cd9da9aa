"""A bar that creeps under a strain that is held."""
from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

YOUNG, EXPONENT, COEFFICIENT, STRAIN, END = 200.0, 4.0, 1e-3, 0.01, 4.0
STRESS = ((YOUNG * STRAIN) ** (1 - EXPONENT) + (EXPONENT - 1) * YOUNG * COEFFICIENT * END) ** (1 / (1 - EXPONENT))


def run(steps, shape="3D8N", length=1.0, stress=1.0):
    m = Model(3, length, stress)
    bar = m.box("Bar", shape, [1, 1, 1], [0.0] * 3, [1.0] * 3)
    m.material(bar, "SmallStrainNortonCreep3D", YOUNG, 0.3, NORTON_COEFFICIENT=COEFFICIENT / stress ** EXPONENT, NORTON_EXPONENT=EXPONENT)
    for axis in "xyz":
        m.fix(bar.side_nodes[axis + "0"], **{axis: 0.0})
    m.fix(bar.side_nodes["x1"], x=STRAIN)
    s = solve(m, steps=steps, end=END)
    return Outcome(s, {"stress": s.reaction(bar.side_nodes["x1"])[0] / STRESS})


CASE = Case(
    "Relaxation by creep", "F. H. Norton 1929; J. T. Boyle, J. Spence, Stress Analysis for Creep, § 2", "ANALYTIC",
    "The stress of a bar under a strain that is held from the first step on, σ = (σ₀^(1−n) + (n − 1) E A t)^(1/(1−n)) with n = 4, from 2 to "
    "0.7367. Backward Euler is of first order in the step; the first step, in which the strain is put on, creeps already. Values are shares of the closed form.",
    [Quantity("stress", 1.0, (8e-3, 4e-3, 2e-3))], (100, 200, 400), run, size=lambda n: 1 / n,
    variants={"hexahedra": {}, "tetrahedra of second order": {"shape": "3D10N"}, "millimetres": {"length": 1e3, "stress": 1e-6}}, quick=["hexahedra"])
