"""Specimens of fracture mechanics: two arms that a layer joins, bent until the crack grows.

Beam theory gives the force F and the deflection δ of the arms of height h, Young's modulus E and width 1 by the length a of the crack,
with G at the energy of fracture: F = √(E h³ G/c)/a, c the coefficient of G = c F² a²/(E h³), and δ = F (p a³ + 2 L³ q)/(8 E h³)."""
import math

from .case import Outcome
from .model import Model
from .solution import solve

YOUNG, HIGH, ENERGIES, EXPONENT = 1e5, 2.0, (0.3, 0.8), 1.6
LAW = {"law": "bilinear", "normal_stiffness": 1e5, "shear_stiffness": 1e5, "normal_strength": 30.0, "shear_strength": 50.0,
       "normal_energy": ENERGIES[0], "shear_energy": ENERGIES[1], "mixed_mode_exponent": EXPONENT}


def energy(shear):
    """Energy of fracture by Benzeggagh and Kenane at the share G_II/G."""
    return ENERGIES[0] + (ENERGIES[1] - ENERGIES[0]) * shear ** EXPONENT


class Specimen:
    """Arms that are pulled apart at the ends, clamped at the other: c is the `coefficient`, p is `cubic`, L is `span`, q is 1."""

    def __init__(self, length, crack, deflection, steps, shear, coefficient, cubic, span):
        self.length, self.crack, self.deflection, self.steps = length, crack, deflection, steps
        self.energy, self.coefficient, self.cubic, self.span = energy(shear), coefficient, cubic, span

    def at(self, crack):
        """Deflection and force of beam theory."""
        stiffness = YOUNG * HIGH ** 3
        force = math.sqrt(stiffness * self.energy / self.coefficient) / crack
        return force * (self.cubic * crack ** 3 + 2 * self.span ** 3) / (8 * stiffness), force

    def force(self, deflection, cracks):
        """Force of beam theory at a deflection, with the crack between two lengths; None beyond them."""
        low, high = cracks
        if not self.at(low)[0] <= deflection <= self.at(high)[0]:
            return None
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self.at(middle)[0] < deflection else (low, middle)
        return self.at(low)[1]

    def run(self, n, cracks, **units):
        m = Model(2, **units)
        arms = [m.box(name, "2D8N", [int(self.length * n), 2], [0.0, low], [self.length, low + HIGH])
                for name, low in (("Upper", 0.0), ("Lower", -HIGH))]
        upper, lower = arms
        for arm in arms:
            m.material(arm, "strain", YOUNG, 0.0)
        joined = lambda point: point[0] > self.crack
        m.interface((upper, "y0", joined), (lower, "y1", joined))
        def node(arm, side, x):
            return min(arm.side_nodes[side], key=lambda i: abs(m.mesh.nodes[i][0] - x))
        m.fix(upper.side_nodes["x1"] + lower.side_nodes["x1"], 0.0, 0.0)
        moved = node(upper, "y0", 0.0)
        m.fix([moved], y=f"{self.deflection / 2!r}*t")
        m.fix([node(lower, "y1", 0.0)], y=f"{-self.deflection / 2!r}*t")
        law = dict(LAW)
        for key in law:
            if key.endswith("_stiffness"):
                law[key] *= m.stress / m.length
            elif key.endswith("_strength"):
                law[key] *= m.stress
            elif key.endswith("_energy"):
                law[key] *= m.stress * m.length
        s = solve(m, "penalty frictional", friction=0.0, steps=self.steps, contact={"cohesive": law, "cohesive_pairs": ["0"]})
        found = [(self.deflection * t, s.reaction([moved], k)[1]) for k, t in enumerate(s.times)]
        right = [(force, self.force(deflection, cracks)) for deflection, force in found]
        ratios = [force / exact for force, exact in right if exact]
        theory = [self.at(cracks[0] + (cracks[1] - cracks[0]) * k / 20) for k in range(21)]
        values = {"force over beam theory": sum(ratios) / len(ratios), "largest deviation": max(abs(r - 1.0) for r in ratios)}
        return Outcome(s, values, curves={"computed": found, "published": theory},
                       labels=("force by deflection: computed (dots), beam theory (line)", "deflection"))
