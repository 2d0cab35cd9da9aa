"""A cup drawn from a round sheet, by rigid shapes and by the same tools meshed."""
import math, resource

from lib.case import Case, Outcome, Quantity
from lib.model import Model, ramp
from lib.solution import solve

YOUNG, POISSON, YIELD, SATURATED, RATE, HARDENING = 2.1e5, 0.3, 250.0, 400.0, 10.0, 200.0  # mm, N
BLANK, THICKNESS, FRICTION, HOLDER = 50.0, 1.0, 0.1, 2e4
PUNCH, CORNER, OPENING, SHOULDER = 25.0, 6.0, 26.5, 8.0
CLAMPED = 0.5  # time at which the holder has its force; from then on the punch goes one unit of length in one of time
INLET = OPENING + SHOULDER
# Profiles of the tools (r, y), which lie to the left: the first point, then ends of lines, and (end, centre) of arcs.
TOOLS = {
    "Die": [(BLANK + 5.0, 0.0), ((INLET, 0.0),), ((OPENING, -SHOULDER), (INLET, -SHOULDER)), ((OPENING, -30.0),)],
    "Punch": [(0.0, THICKNESS), ((PUNCH - CORNER, THICKNESS),), ((PUNCH, THICKNESS + CORNER), (PUNCH - CORNER, THICKNESS + CORNER)),
              ((PUNCH, THICKNESS + 30.0),)],
    "Holder": [(INLET - 2.0, THICKNESS + 2.0), ((INLET, THICKNESS), (INLET, THICKNESS + 2.0)), ((BLANK + 5.0, THICKNESS),)],
}


def chain(profile, angle, size):
    """Points on a profile: arcs in steps of `angle` degrees at most, lines of about `size`."""
    out = [profile[0]]
    for end, *centre in profile[1:]:
        at = out[-1]
        if centre:
            (c,) = centre
            begin, finish = (math.atan2(p[1] - c[1], p[0] - c[0]) for p in (at, end))
            turn = (finish - begin) % (2 * math.pi)
            count = math.ceil(math.degrees(turn) / angle - 1e-9)
            place = lambda s: (c[0] + math.dist(at, c) * math.cos(begin + s * turn), c[1] + math.dist(at, c) * math.sin(begin + s * turn))
        else:
            count = max(1, round(math.dist(at, end) / size))
            place = lambda s: (at[0] + s * (end[0] - at[0]), at[1] + s * (end[1] - at[1]))
        out += [place(i / count) for i in range(1, count)] + [end]
    return out


def rigid_tools(m, way, angle):
    """Rigid shapes, moved by their reference nodes."""
    for name, profile in TOOLS.items():
        segments = [{"arc_to": s[0], "centre": s[1]} if s[1:] else {"line_to": s[0]} for s in profile[1:]]
        point = "Structure.Point_" + name
        m.process("rigid_shape_process", {"model_part_name": "Structure." + name, "reference_model_part_name": point, "facet_angle": angle,
            "facet_size": 2.0, "shape": {"name": "revolution", "start": profile[0], "segments": segments}})
        value = [0.0, {"Die": 0.0, "Punch": way, "Holder": None}[name], None]
        m.process("assign_vector_variable_process", {"model_part_name": point, "variable_name": "DISPLACEMENT",
            "constrained": [v is not None for v in value], "value": value, "interval": [0.0, "End"]})
    m.process("assign_vector_variable_to_conditions_process", {"model_part_name": "Structure.Point_Holder", "variable_name": "POINT_LOAD",
        "value": [0.0, f"-{HOLDER!r}*{ramp(0.0, CLAMPED)}", 0.0], "interval": [0.0, "End"]}, "loads")
    return lambda s, name, step: s.number("REACTION_Y of Structure.Point_" + name, step)


def meshed_tools(m, way, angle):
    """Tools of one layer of elements, all nodes of which are prescribed; those of the holder move alike under its force."""
    nodes = {}
    for name, profile in TOOLS.items():
        front, back = chain(profile, angle, 2.0), []
        for i, p in enumerate(front):
            a, b = front[max(i - 1, 0)], front[min(i + 1, len(front) - 1)]
            back.append((p[0] - (b[1] - a[1]) / math.dist(a, b), p[1] + (b[0] - a[0]) / math.dist(a, b)))
        count = len(front) - 1
        at = lambda s, t: tuple(a + t * (b - a) for a, b in zip(front[round(s)], back[round(s)]))
        body = m.box("Body" + name, "2D4N", [count, 1], [0, 0], [count, 1], at, element="AxisymTotalLagrangianElement")
        m.material(body, "HyperElasticAxisym2DLaw", YOUNG, POISSON, THICKNESS=1.0)
        facets = m._facets(body, "y0")
        m.mesh.part(name, m._nodes_of(facets), (), facets)
        m.fix(body.nodes, x=0.0, y={"Die": 0.0, "Punch": way, "Holder": None}[name])
        nodes[name] = body.nodes
    m.rigid(nodes["Holder"], "DISPLACEMENT_Y")
    m.point_load(nodes["Holder"][:1], [0.0, -HOLDER, 0.0], ramp(0.0, CLAMPED))
    return lambda s, name, step: s.reaction(nodes[name], step)[1]


def deck(n, tools, angle, travel, step):
    """The model, its sheet, what solves it, and the force of a tool in a step of the solution."""
    m = Model(2)
    sheet = m.box("Sheet", "2D4N", [40 * n, n + 1], [0.0, 0.0], [BLANK, THICKNESS], element="AxisymTotalLagrangianElement")
    m.material(sheet, "FiniteStrainIsotropicPlasticityAxisymVonMisesVonMises", YOUNG, POISSON, THICKNESS=1.0, YIELD_STRESS=YIELD,
               EXPONENTIAL_SATURATION_YIELD_STRESS=SATURATED, HARDENING_EXPONENT=RATE, ISOTROPIC_HARDENING_MODULUS=HARDENING)
    m.roll(sheet.side_nodes["x0"], x=0.0)
    contact = {"contact_model_part": {}, "assume_master_slave": {}, "alternative_formulations": {"axisymmetric": True}}
    for side, masters in (("y0", ["Die"]), ("y1", ["Punch", "Holder"])):
        number = str(len(m.pairs))
        m.between(m._facets(sheet, side), [])
        interface, slave = m.pairs[-1]
        contact["contact_model_part"][number], contact["assume_master_slave"][number] = [interface, *masters], [slave]
    force = tools(m, f"-{travel!r}*{ramp(CLAMPED, CLAMPED + travel)}", angle)
    return m, sheet, dict(family="ALM frictional", friction=FRICTION, contact=contact, end=CLAMPED + travel, time_step=step), force


def drawn(*settings):
    """A solution with its punch force over travel, the forces out of balance, the volume and radius of the sheet, and processor time."""
    m, sheet, solver, force = deck(*settings)
    begin = resource.getrusage(resource.RUSAGE_CHILDREN)
    s = solve(m, **solver)
    end = resource.getrusage(resource.RUSAGE_CHILDREN)
    s.seconds = end.ru_utime - begin.ru_utime + end.ru_stime - begin.ru_stime
    s.forces, s.lost = [], 0.0
    for k, t in enumerate(s.times):
        punch, die = force(s, "Punch", k), force(s, "Die", k)
        s.forces.append((t - CLAMPED, -punch))
        s.lost = max(s.lost, abs(punch + die - HOLDER * min(1.0, t / CLAMPED)) / abs(die))
    u = s.u(sheet.nodes)
    now = {i: (p[0] + u[i][0], p[1] + u[i][1]) for i, p in s.at(sheet.nodes).items()}
    volume = 0.0
    for cell in sheet.cells:
        for (x, y), (z, w) in zip((now[i] for i in cell), (now[i] for i in cell[1:] + cell[:1])):
            volume += math.pi / 3 * (x + z) * (x * w - z * y)
    s.volume = volume / (math.pi * BLANK ** 2 * THICKNESS)
    s.rim = max(x for x, _ in now.values())
    return s


def strength(inner, outer):
    """Flow stress where a ring of the radius `inner` in a flange of the outer radius `outer` has been narrowed to, at constant thickness."""
    strain = 0.5 * math.log((BLANK ** 2 - outer ** 2 + inner ** 2) / inner ** 2)
    return YIELD + (SATURATED - YIELD) * (1 - math.exp(-RATE * strain)) + HARDENING * strain


def siebel(rim):
    """Drawing force by Siebel: narrowing of the flange, friction of the holder and of the shoulder, bending over the shoulder."""
    mean = 0.5 * (PUNCH + OPENING)
    rope = math.exp(0.5 * math.pi * FRICTION)
    narrowing = 1.1 * rope * 0.5 * (strength(rim, rim) + strength(mean, rim)) * math.log(rim / mean)
    holding = rope * 2 * FRICTION * HOLDER / (2 * math.pi * rim * THICKNESS)
    return 2 * math.pi * mean * THICKNESS * (narrowing + holding + strength(mean, rim) * THICKNESS / (2 * SHOULDER))


def run(n, travel=20.0, step=0.1, angle=2.0):
    rigid, meshed = drawn(n, rigid_tools, 5.0, travel, step), drawn(n, meshed_tools, angle, travel, step)
    at = lambda s, way: s.forces[s.step_at(CLAMPED + way)][1]
    ways = [travel * k / 10 for k in range(1, 11)]
    values = {"punch force off that of meshed tools": max(abs(at(rigid, w) / at(meshed, w) - 1) for w in ways),
              "processor time beyond that of meshed tools": max(0.0, rigid.seconds / meshed.seconds - 1),
              "forces of the tools out of balance": max(rigid.lost, meshed.lost),
              "volume of the sheet": rigid.volume, "force over Siebel's": at(rigid, travel) / siebel(rigid.rim)}
    return Outcome([rigid, meshed], values, curves={"computed": rigid.forces, "published": meshed.forces}, labels=("travel of the punch", "its force"))


CASE = Case(
    "Cup drawing", "tools as rigid shapes beside the same tools meshed; balance of forces; Siebel's drawing force (E. Siebel 1954; K. Lange, Umformtechnik 3)", "EXTERNAL",
    "A steel sheet, 100 mm wide and 1 mm thick, under a holder of 20 kN is drawn by a punch of 50 mm over a shoulder of 8 mm, with friction of 0.1. The "
    "facets of meshed tools are flat, 2° on arcs; those of rigid shapes span 5° of the true arc. Volume changes elastically, by mean stress over bulk modulus. "
    "Siebel's formula is an estimate, good to a tenth, at the radius that the flange has.",
    [Quantity("punch force off that of meshed tools", 0.0, 0.01, scale=1.0, order=False),
     Quantity("processor time beyond that of meshed tools", 0.0, 0.02, scale=1.0, order=False),
     Quantity("forces of the tools out of balance", 0.0, 1e-4, scale=1.0, order=False),
     Quantity("volume of the sheet", 1.0, 3e-3, order=False),
     Quantity("force over Siebel's", 1.0, 0.1, tag="ANALYTIC", order=False)],
    (1,), run, quick=False, slow=True)
