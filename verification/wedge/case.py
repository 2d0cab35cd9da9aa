"""A wedge driven along a block: the ratio of drive and thrust is tan(β + φ)."""
import math

from lib.case import Case, Outcome, Quantity
from lib.model import Model
from lib.solution import solve

YOUNG, POISSON, SLOPE, DRIVE = 1e6, 0.2, 20.0, 4e-3


def run(n, family="ALM", friction=0.0, slave="wedge", steps=2, **units):
    m, tan = Model(2, **units), math.tan(math.radians(SLOPE))
    face = lambda y: 1.0 + y * tan  # of the contact, on the wedge's right
    wedge = m.box("Wedge", "2D4N", [n, n + 1], [0.0, 0.0], [1.0, 1.0], lambda s, y: (s * face(y), y))
    block = m.box("Block", "2D4N", [n, 2 * n], [0.0, -0.5], [1.0, 1.5], lambda s, y: (face(y) + s * (3.0 - face(y)), y))
    for body in (wedge, block):
        m.material(body, "strain", YOUNG, POISSON)
    m.roll(wedge.side_nodes["x0"], x=0.0)
    m.roll(wedge.side_nodes["y1"], y=f"{-DRIVE!r}*t")
    m.fix(block.side_nodes["x1"], x=0.0, y=0.0)
    sides = [(wedge, "x1"), (block, "x0")]
    m.interface(*(sides if slave == "wedge" else sides[::-1]))
    s = solve(m, family, friction=friction if "frictional" in family else None, steps=steps)
    thrust, drive = s.reaction(block.side_nodes["x1"])[0], -s.reaction(wedge.side_nodes["y1"])[1]
    return Outcome(s, {"drive over thrust": drive / -thrust if thrust else 0.0})


def ratio(variant):
    return math.tan(math.radians(SLOPE) + math.atan(variant.get("friction", 0.0)))


F = {"family": "ALM frictional"}
CASE = Case(
    "Wedge", "balance of a wedge of slope β with the angle of friction φ: drive over thrust is tan(β + φ)", "ANALYTIC",
    "The interface rotates with the strain of 0.2 %, which affects the ratio.",
    [Quantity("drive over thrust", ratio, 5e-3, order=False)], (3, 6), run, size=lambda n: 1 / n,
    variants={"frictionless": {}, "components": {"family": "ALM components"}, "penalty": {"family": "penalty"}, "perturbed": {"family": "perturbed"},
              "MPC": {"family": "MPC"}, "block as slave": {"slave": "block"}, "μ = 0.2": {**F, "friction": 0.2}, "μ = 0.2, block as slave": {**F, "friction": 0.2, "slave": "block"},
              "μ = 0.5": {**F, "friction": 0.5}, "μ = 0.2, 8 steps": {**F, "friction": 0.2, "steps": 8},
              "μ = 0.2, penalty": {"family": "penalty frictional", "friction": 0.2}, "μ = 0.2, MPC": {"family": "MPC frictional", "friction": 0.2},
              "millimetres": {**F, "friction": 0.2, "length": 1e3, "stress": 1e-6}}, quick=["frictionless", "MPC", "μ = 0.2, MPC"])
