"""Specimens of fracture mechanics: two arms that a layer joins, bent until the crack grows.

Beam theory gives the force F and the deflection δ of the arms of height h, Young's modulus E and width 1 by the length a of the crack,
with G at the energy of fracture: F = √(E h³ G/c)/a, c the coefficient of G = c F² a²/(E h³), and δ = F (p a³ + 2 L³)/(8 E h³). Both follow
the crack: a force at a deflection has no part of what lengthens the crack, the rotation at its tip and the zone of softening."""
import math

from .case import Case, Outcome, Quantity
from .model import Model
from .solution import solve

YOUNG, HIGH = 1e5, 2.0
LAW = {"law": "bilinear", "normal_stiffness": 1e5, "shear_stiffness": 1e5, "normal_strength": 30.0, "shear_strength": 50.0,
       "normal_energy": 0.3, "shear_energy": 0.8, "mixed_mode_exponent": 1.6}
# Length on which the lips touch above the support.
LIP = 3.0


def scaled(law, model):
    """A law of the layer in the units of a model."""
    units = {"stiffness": model.stress / model.length, "strength": model.stress, "energy": model.stress * model.length}
    return {key: value * units.get(key.split("_")[-1], 1.0) if key != "law" else value for key, value in law.items()}


def ends_of_cells(pieces):
    """Ends of cells on pieces that follow each other: each its ends and the largest cell."""
    out = [pieces[0][0]]
    for low, high, size in pieces:
        count = math.ceil((high - low) / size - 1e-9)
        out += [low + (high - low) * (k + 1) / count for k in range(count)]
    return out


class Specimen:
    """Arms whose ends are pulled apart, the others clamped ("cantilevers"), or that are bent in three points ("flexure")."""

    # Energy of fracture, coefficient c and p of the loadings.
    LOADINGS = {"cantilevers": (LAW["normal_energy"], 12.0, 64.0), "flexure": (LAW["shear_energy"], 9 / 16, 3.0)}

    def __init__(self, loading, length, crack, deflection, steps):
        self.loading, self.length, self.crack, self.deflection, self.steps = loading, length, crack, deflection, steps
        self.energy, self.coefficient, self.cubic = self.LOADINGS[loading]
        # Half of the distance of the supports, L.
        self.span = 0.0 if loading == "cantilevers" else 0.5 * length

    def case(self, title, law, neglected, cracks, note):
        """The case of the atlas: forces against beam theory while the crack grows between two lengths."""
        return Case(
            title, f"linear fracture mechanics of beams: {law}", "ANALYTIC", neglected,
            [Quantity("force over beam theory", 1.0, 0.03, order=False), Quantity("largest deviation", 0.0, 0.03, scale=1.0, order=False)],
            (1,), lambda n, **units: self.run(n, cracks, **units), variants={"": {}, "millimetres": {"length": 1e3, "stress": 1e-6}},
            quick=False, note=note)

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

    def stations(self, n, cracks):
        """Ends of the cells: n on a length of 1 where the crack grows, a quarter of that elsewhere."""
        places = sorted({0.0, LIP, self.crack, cracks[1] + 5.0, self.span, self.length})
        size = lambda low, high: (1.0 if low >= self.crack and high <= cracks[1] + 5.0 else 4.0) / n
        return ends_of_cells([(low, high, size(low, high)) for low, high in zip(places, places[1:])])

    def run(self, n, cracks, **units):
        m = Model(2, **units)
        along = self.stations(n, cracks)
        arms = [m.graded(name, "2D8N", [along, [low, low + 0.5 * HIGH, low + HIGH]]) for name, low in (("Upper", 0.0), ("Lower", -HIGH))]
        upper, lower = arms
        for arm in arms:
            m.material(arm, "strain", YOUNG, 0.0)
        joined = lambda point: point[0] > self.crack
        m.interface((upper, "y0", joined), (lower, "y1", joined))
        node = lambda arm, side, x: min(arm.side_nodes[side], key=lambda i: abs(m.mesh.nodes[i][0] - x))
        if self.loading == "cantilevers":
            m.fix(upper.side_nodes["x1"] + lower.side_nodes["x1"], 0.0, 0.0)
            moved, sign, way = node(upper, "y0", 0.0), 1.0, 0.5 * self.deflection
            m.fix([node(lower, "y1", 0.0)], y=f"{-way!r}*t")
        else:
            moved, sign, way = node(upper, "y1", self.span), -1.0, self.deflection
            m.fix([node(lower, "y0", 0.0)], y=0.0)
            m.fix([node(lower, "y0", self.length)], 0.0, 0.0)
            touching = lambda point: point[0] < LIP
            m.interface((upper, "y0", touching), (lower, "y1", touching))
        m.fix([moved], y=f"{sign * way!r}*t")
        s = solve(m, "penalty frictional", friction=0.0, steps=self.steps, contact={"cohesive": scaled(LAW, m), "cohesive_pairs": ["0"]})
        found = [(self.deflection * t, sign * s.reaction([moved], k)[1]) for k, t in enumerate(s.times)]
        right = [(force, self.force(deflection, cracks)) for deflection, force in found]
        ratios = [force / exact for force, exact in right if exact]
        theory = [self.at(cracks[0] + (cracks[1] - cracks[0]) * k / 20) for k in range(21)]
        values = {"force over beam theory": sum(ratios) / len(ratios), "largest deviation": max(abs(r - 1.0) for r in ratios)}
        return Outcome(s, values, curves={"computed": found, "published": theory},
                       labels=("force by deflection: computed (dots), beam theory (line)", "deflection"))
