"""Double cantilever beam under uneven bending moments: the layer of a specimen between higher arms, opened in any mixture of modes.

The ends of the arms are turned, so that moments M₁ and M₂ bend them. With M_s = (M₁ − M₂)/2 and M_a = (M₁ + M₂)/2 the energy of the two
arms, by length, less that of the whole beam ahead is G = G_I + G_II, G_I = 12 M_s²/(E h³) and G_II = 9 M_a²/(E h³): M_s alone opens the
crack and M_a alone slides it, by symmetry. G is the J integral along the outline, which is exact whatever the length of the crack and of
the zone of softening. Turns that grow with the crack, by beam theory, keep both moments where they are."""
import math

from .case import Case, Outcome, Quantity
from .model import Model
from .solution import solve
from .specimen import LAW, YOUNG, ends_of_cells, scaled

HIGH = 20.0
INERTIA = YOUNG * HIGH ** 3 / 12
# Length of the arms at first and at last, and of the whole.
FIRST, LAST, LENGTH = 3.0 * HIGH, 4.5 * HIGH, 8.0 * HIGH
# Length of the zone of softening and the rotation at its tip, in which the arms are longer, opening and sliding.
LONGER = (0.65 * HIGH, 0.2 * HIGH)
# Time at which the crack begins to grow, and from which it has the whole zone of softening behind it.
BEGIN, STEADY = 0.25, 0.6


def fracture(mixture):
    """Energy of fracture by Benzeggagh and Kenane at G_II/G."""
    return LAW["normal_energy"] + (LAW["shear_energy"] - LAW["normal_energy"]) * mixture ** LAW["mixed_mode_exponent"]


def moments(mixture):
    """M_s and M_a at which the crack grows."""
    energy = fracture(mixture) * YOUNG * HIGH ** 3
    return math.sqrt((1.0 - mixture) * energy / 12), math.sqrt(mixture * energy / 9)


def turns(mixture, arm):
    """Half of the angle between the ends of arms of this length, and their mean."""
    (opening, sliding), (rear_opened, rear_slid) = moments(mixture), (arm + longer for longer in LONGER)
    return opening * rear_opened / INERTIA, sliding * (rear_slid + (LENGTH - rear_slid) / 4) / INERTIA


def course(first, last):
    """A function of time that rises to `first` and then slowly to `last`."""
    return f"({first / BEGIN!r}*t if t < {BEGIN!r} else {first!r} + {(last - first) / (1.0 - BEGIN)!r}*(t - {BEGIN!r}))"


def stations(n):
    """Ends of the cells along the arms and across them: n in a height where the crack grows, a quarter of that elsewhere."""
    fine = HIGH / n
    grown = LAST + 1.5 * HIGH
    along = ends_of_cells([(0.0, FIRST, 4 * fine), (FIRST, grown, fine), (grown, LENGTH, 4 * fine)])
    across, size = [0.0], 0.5 * fine
    while across[-1] + 1.5 * size < HIGH:
        across.append(across[-1] + size)
        size *= 2.0
    return along, across + [HIGH]


def grow(mixture, n, steps, **units):
    """Grows a crack at G_II/G; gives the solution, and the energies of release G_I and G_II by step from `STEADY` on."""
    m = Model(2, **units)
    along, across = stations(n)
    upper = m.graded("Upper", "2D8N", [along, across])
    lower = m.graded("Lower", "2D8N", [along, [-y for y in reversed(across)]])
    for arm in (upper, lower):
        m.material(arm, "strain", YOUNG, 0.0)
    joined = lambda point: point[0] > FIRST
    m.interface((upper, "y0", joined), (lower, "y1", joined))
    rear = upper.side_nodes["x1"] + lower.side_nodes["x1"]
    m.fix(rear, x=0.0)
    m.fix([i for i in upper.side_nodes["x1"] if m.mesh.nodes[i][1] == 0.0], y=0.0)
    (opened, slid), (opened_last, slid_last) = turns(mixture, FIRST), turns(mixture, LAST)
    for arm, sign in ((upper, -1.0), (lower, 1.0)):
        hub = "Structure.Hub" + arm.name
        # The end stays plane, and free to move along and to narrow.
        m.process("kinematic_coupling_process", {
            "model_part_name": "Structure." + m.part(arm.side_nodes["x0"]), "reference_model_part_name": hub,
            "reference_point": [0.0, -0.5 * sign * HIGH * m.length, 0.0], "components": [True, False, False]})
        m.process("assign_vector_variable_process", {"model_part_name": hub, "variable_name": "DISPLACEMENT",
            "constrained": [False, True, False], "value": [None, 0.0, None], "interval": [0.0, "End"]})
        m.process("assign_vector_variable_process", {"model_part_name": hub, "variable_name": "ROTATION",
            "constrained": [False, False, True], "value": [None, None, course(sign * opened + slid, sign * opened_last + slid_last)],
            "interval": [0.0, "End"]})
    s = solve(m, "penalty frictional", friction=0.0, steps=steps, contact={"cohesive": scaled(LAW, m)})
    unit, found = m.stress * m.length ** 2, []
    for step, time in enumerate(s.times):
        if time >= STEADY:
            first, second = (s.number(f"REACTION_MOMENT_Z of Structure.Hub{name}", step) / unit for name in ("Lower", "Upper"))
            found.append((3.0 * (first - second) ** 2 / (YOUNG * HIGH ** 3), 2.25 * (first + second) ** 2 / (YOUNG * HIGH ** 3)))
    return s, found


def run(n, mixtures, steps, **units):
    solutions, ratios, points = [], [], []
    for mixture in mixtures:
        s, found = grow(mixture, n, steps, **units)
        solutions.append(s)
        ratios += [(g + h) / fracture(h / (g + h)) for g, h in found]
        opening, sliding = (sum(own) / len(found) for own in zip(*found))
        points.append((sliding / (opening + sliding), opening + sliding))
    values = {"energy over Benzeggagh and Kenane": sum(ratios) / len(ratios), "largest deviation": max(abs(r - 1.0) for r in ratios)}
    return Outcome(solutions, values, curves={"computed": points, "published": [(0.02 * k, fracture(0.02 * k)) for k in range(51)]},
                   labels=("energy by mixture: computed (dots), formula (line)", "G_II/G"))


def case(title, source, neglected, mixtures, steps, note):
    """The case of the atlas: energies of release at some G_II/G against the energy of fracture."""
    return Case(
        title, source, "ANALYTIC", neglected,
        [Quantity("energy over Benzeggagh and Kenane", 1.0, 0.01, order=False), Quantity("largest deviation", 0.0, 0.01, scale=1.0, order=False)],
        (16,), lambda n, **units: run(n, mixtures, steps, **units), variants={"": {}, "millimetres": {"length": 1e3, "stress": 1e-6}},
        quick=False, note=note)
