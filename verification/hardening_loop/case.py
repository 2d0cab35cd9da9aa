"""A bar that yields to and fro: the loop of Armstrong and Frederick."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

YOUNG, YIELD, MODULUS, RATE, STRAIN = 200.0, 0.4, 40.0, 80.0, 0.02
LIMIT = MODULUS / RATE


def back_stresses():
    """Back stress at the ends of the three branches: X = ± C/γ + (X₀ ∓ C/γ) exp(∓ γ (ε_p − ε_p0)), ε = ε_p + (X ± σ_y)/E."""
    out, back, plastic = [], 0.0, 0.0
    for sign in (1.0, -1.0, 1.0):
        strain, start, before = sign * STRAIN, back, plastic
        low, high = (before, strain) if sign > 0 else (strain, before)
        for _ in range(200):  # the plastic strain, by halving
            plastic = 0.5 * (low + high)
            back = sign * LIMIT + (start - sign * LIMIT) * math.exp(-sign * RATE * (plastic - before))
            low, high = (plastic, high) if plastic + (back + sign * YIELD) / YOUNG < strain else (low, plastic)
        out.append(back + sign * YIELD)
    return out


STRESSES = back_stresses()


def run(steps, shape="3D8N", length=1.0, stress=1.0):
    m = Model(3, length, stress)
    bar = m.box("Bar", shape, [1, 1, 1], [0.0] * 3, [1.0] * 3)
    m.material(bar, "SmallStrainKinematicPlasticity3DVonMisesVonMises", YOUNG, 0.3, YIELD_STRESS=YIELD * stress,
               KINEMATIC_HARDENING_TYPE=1, KINEMATIC_PLASTICITY_PARAMETERS=[MODULUS * stress, RATE])
    for axis in "xyz":
        m.fix(bar.side_nodes[axis + "0"], **{axis: 0.0})
    m.fix(bar.side_nodes["y1"], y=f"{STRAIN!r}*(t - 1.5*(abs(t - 1.0) + t - 1.0) + 2.0*(abs(t - 2.0) + t - 2.0))")
    s = solve(m, steps=3 * steps, end=3.0)
    pulled = lambda branch: s.reaction(bar.side_nodes["y1"], steps * branch - 1)[1]
    return Outcome(s, {f"stress after branch {k}": pulled(k) for k in (1, 2, 3)})


CASE = Case(
    "Kinematic hardening in a loop", "P. J. Armstrong, C. O. Frederick 1966; J. Lemaitre, J.-L. Chaboche, Mechanics of Solid Materials, § 5.4", "ANALYTIC",
    "The back stress X of a bar under strain that goes to and fro tends to ± C/γ over each branch; the stress is X ± σ_y. Backward Euler is "
    "of first order in the step.",
    [Quantity(f"stress after branch {k + 1}", value, (4e-3, 2e-3, 1e-3)) for k, value in enumerate(STRESSES)],
    (100, 200, 400), run, size=lambda n: 1 / n,
    variants={"hexahedra": {}, "tetrahedra": {"shape": "3D4N"}, "millimetres": {"length": 1e3, "stress": 1e-6}}, quick=["hexahedra"])
