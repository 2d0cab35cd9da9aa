"""Contact of curved bodies with closed forms: Hertz between spheres, Cattaneo and Mindlin between cylinders.

Both bodies are blocks many contact widths wide whose facing sides bulge by an arc around the contact; beyond it they are
flat, so that far away they are the half-spaces of the closed forms."""
import math

from deck import *
from friction import MULTIPLIER, TIGHT
from mesh import Mesh


def stations(size, fine, end, growth=1.25):
    """From 0 to `end`: uniform up to `fine`, then growing by about `growth`."""
    count = round(fine / size)
    at = [fine * i / count for i in range(count + 1)] if count else [0.0]
    rest = end - at[-1]
    steps = max(1, round(math.log(1.0 + rest / size * (growth - 1.0)) / math.log(growth)))
    low, high = 1.0, 3.0
    for _ in range(80):
        ratio = 0.5 * (low + high)
        low, high = (ratio, high) if size * sum(ratio ** i for i in range(1, steps + 1)) < rest else (low, ratio)
    step = size
    for _ in range(steps - 1):
        step *= ratio
        at.append(at[-1] + step)
    return at + [end]


class Bulge:
    """A block on one side of y = 0 whose surface bulges towards it; `sign` +1 above, -1 below."""

    def __init__(self, mesh, name, element, sign, radius, arc, xs, depth, size):
        self.name, self.mesh, self.sign = name, mesh, sign
        profile = lambda x: radius - math.sqrt(radius ** 2 - min(abs(x), arc) ** 2)
        rows = [d / depth for d in stations(size, 0.0, depth)]
        self.rows = [[mesh.add_node((x, sign * (profile(x) + s * (depth - profile(x))))) for x in xs] for s in rows]
        cells = []
        for near, far in zip(self.rows, self.rows[1:]):
            for i in range(len(xs) - 1):
                cell = (near[i], near[i + 1], far[i + 1], far[i])
                cells.append(cell if sign > 0 else (cell[3], cell[2], cell[1], cell[0]))
        self.elements = [mesh.add_element(element, cell) for cell in cells]
        self.nodes = sorted(n for row in self.rows for n in row)
        self.skin = []
        mesh.part(name, self.nodes, self.elements)

    def conditions(self, row, kind, outward_up, reach=math.inf):
        """Edges of a row of nodes whose outward normal points up or down, within `reach` of the axis."""
        made, facets = [], []
        for a, b in zip(row, row[1:]):
            if max(abs(self.mesh.nodes[n][0]) for n in (a, b)) <= reach:
                facets.append((b, a) if outward_up else (a, b))
                made.append(self.mesh.add_condition(kind, facets[-1]))
        self.skin += made
        self.mesh.part(self.name, self.nodes, self.elements, self.skin)
        return made, sorted({n for f in facets for n in f})


class Variant:
    """A case with loads of which a part acts, lengths at the contact that go with them, and a coarser mesh."""

    def __init__(self, name="", load=1.0, length=1.0, coarser=1.0):
        self.name, self.load, self.length, self.size = name, load, length, length * coarser


def pair(mesh, element, radius, arc, ends, depth, sizes, fine, reach, load="LineLoadCondition2D2N"):
    """Both bodies with their contact and load parts; `ends` are the least and the largest x."""
    bodies = []
    for name, sign, size in (("Lower", -1, sizes[0]), ("Upper", 1, sizes[1])):
        right = stations(size, fine, ends[1])
        xs = ([-x for x in reversed(right[1:])] if ends[0] < 0 else []) + right
        bodies.append(Bulge(mesh, name, element, sign, radius, arc, xs, depth, size))
    lower, upper = bodies
    slave, slave_nodes = upper.conditions(upper.rows[0], "LineCondition2D2N", False, reach)
    master, master_nodes = lower.conditions(lower.rows[0], "LineCondition2D2N", True, reach)
    mesh.part("Slave", slave_nodes, (), slave)
    mesh.part("Interface", sorted(slave_nodes + master_nodes), (), slave + master)
    top, _ = upper.conditions(upper.rows[-1], load, True)
    mesh.part("Top", upper.rows[-1], (), top)
    mesh.part("Bottom", lower.rows[-1])
    return lower, upper, slave_nodes


def cattaneo_mindlin(variant, tolerances, method="ALM", times=(2.0,)):
    """Two cylinders pressed together, then sheared: slip spreads from the edges of the contact inwards.

    The shear grows from t = 1 to t = 2; `times` are those at which tractions are compared."""
    young, poisson, radius, friction = 200.0, 0.3, 8.0, 0.2
    force, shear = (2 * radius * 0.625 * variant.load, 2 * radius * 0.05851 * variant.load)
    modulus, relative = young / (2 * (1 - poisson ** 2)), radius / 2
    half = math.sqrt(4 * force * relative / (math.pi * modulus))
    peak = 2 * force / (math.pi * half)
    penalty = method == "Penalty"
    stick_at = lambda time: half * math.sqrt(1 - shear * (time - 1.0) / (friction * force))
    width, mesh = 20.0, Mesh()
    lower, upper, slave = pair(mesh, "SmallDisplacementElement2D4N", radius, 2.0, (-width, width), width,
                               (0.04 * variant.size, 0.036 * variant.size), 0.9 * variant.length, 2.0 * variant.length)
    clamp = process("impose_rigid_movement_process", {
        "model_part_name": "Top", "master_variable_name": "DISPLACEMENT", "interval": [0.0, "End"]},
        KRATOS + ".StructuralMechanicsApplication")
    constraints = [fix("Bottom", x=0.0, y=0.0), clamp]
    down, side = force / (2 * width), shear / (2 * width)
    mesh.part("Side", upper.rows[-1], (), upper.conditions(upper.rows[-1], "LineLoadCondition2D2N", True)[0])
    # the contact grows evenly with time: nodes that enter late in a step carry the slip of all of it
    loads = [condition_load("Top", "LINE_LOAD", f"{down}*t*t if t < 1.0 else {down}", [0.0, -1.0, 0.0]),
             condition_load("Side", "LINE_LOAD", f"{side}*(t - 1.0) if t > 1.0 else 0.0", [1.0, 0.0, 0.0])]
    checks = []
    pressure = lambda x: peak * math.sqrt(max(0.0, 1 - (x / half) ** 2))
    traction = lambda x, stick: friction * pressure(x) - (
        friction * peak * stick / half * math.sqrt(1 - (x / stick) ** 2) if abs(x) < stick else 0.0)
    normal, tangential = (("AUGMENTED_NORMAL_CONTACT_PRESSURE", "pressure.json", -1.0), "FRICTION_TRACTION_X") if penalty else (
        (MULTIPLIER + "_Y", "slave.json", 1.0), MULTIPLIER + "_X")
    for time, node in ((time, node) for time in times for node in slave):
        when = {"time": time} if len(times) > 1 else {}
        x, stick = mesh.nodes[node][0], stick_at(time)
        # next to the edges of contact and stick the closed forms are steep, and a node is loaded or not
        if abs(abs(x) - half) > 0.1 * variant.length:
            checks.append(check(normal[0], tolerances[0] * peak, normal[1], nodes=[node], value=round(normal[2] * pressure(x), 6), **when))
            if abs(abs(x) - stick) > 0.06 * variant.length:
                checks.append(check(tangential, tolerances[1] * friction * peak, "slave.json", nodes=[node],
                                    value=round(-traction(x, stick), 6), **when))
    outputs = [json_output("slave.json", ["FRICTION_TRACTION" if penalty else MULTIPLIER], "Slave")]
    if penalty:
        outputs.append(json_output("pressure.json", ["AUGMENTED_NORMAL_CONTACT_PRESSURE"], "Slave", historical=False))
    settings = contact_solver(2, "mesh", 0.125, method + "ContactFrictional", residual_absolute_tolerance=1e-12, residual_relative_tolerance=1e-8,
                              max_iteration=40, buffer_size=3, contact_settings={**TIGHT, "contact_residual_absolute_tolerance": 1e-12})
    write_case("contact_2d/cattaneo_mindlin" + variant.name + penalty * "_penalty", "Two pressed cylinders that are sheared slide at the edges of their contact and stick within.",
               f"Half-planes under a half-width of {half:.5f} mm with the peak {peak:.5f} N/mm², sticking up to {stick_at(2.0):.5f} mm at the end; strains "
               f"reach {0.05 * variant.length:g}, which the closed forms neglect.",
               parameters("mesh", settings, constraints, loads,
                          [contact_process([("Interface", "Slave")], "Frictional", method.lower(), friction_coefficients={"0": friction},
                                           **({} if penalty else {"advance_ALM_parameters": {"use_scale_factor": False}}))],
                          outputs, 2.0),
               [material(b.name, i, "strain", young, poisson) for i, b in enumerate((lower, upper), 1)], mesh, checks)


def hertz_spheres(variant, tolerance):
    """Two spheres, one a hundred times stiffer, in their meridional plane."""
    stiff, soft, poisson, radius, force = 1.0e8, 1.0e6, 0.29, 12.2474 / 2, 117808.787 * variant.load
    modulus = 1.0 / ((1 - poisson ** 2) * (1 / stiff + 1 / soft))
    half = (3 * force * radius / 2 / (4 * modulus)) ** (1 / 3)
    peak = 3 * force / (2 * math.pi * half ** 2)
    width, mesh = 15.0, Mesh()
    lower, upper, slave = pair(mesh, "AxisymSmallDisplacementElement2D4N", radius, 2.0, (0.0, width), width,
                               (0.036 * variant.size, 0.04 * variant.size), 0.9 * variant.length, 2.0 * variant.length,
                               "AxisymLineLoadCondition2D2N")
    mesh.part("Axis", [row[0] for body in (lower, upper) for row in body.rows])
    constraints = [fix("Bottom", y=0.0), fix("Axis", x=0.0)]
    # the contact then grows evenly with time
    loads = [condition_load("Top", "LINE_LOAD", f"{force / (math.pi * width ** 2)}*t*t*t", [0.0, -1.0, 0.0])]
    checks = []
    for node in slave:
        x = mesh.nodes[node][0]
        if abs(x - half) > 0.1 * variant.length:
            value = peak * math.sqrt(max(0.0, 1 - (x / half) ** 2))
            checks.append(check("LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", tolerance * peak, "slave.json", nodes=[node], value=round(-value, 3)))
    settings = contact_solver(2, "mesh", 0.1, residual_absolute_tolerance=1e-6 * variant.load,
                              residual_relative_tolerance=1e-8 if variant.load == 1.0 else 1e-10, max_iteration=40,
                              contact_settings={"contact_residual_absolute_tolerance": 1e-12 * variant.load})
    materials = [material(b.name, i, "strain", young, poisson) for i, (b, young) in enumerate(((lower, soft), (upper, stiff)), 1)]
    for entry in materials:
        entry["Material"]["constitutive_law"]["name"] = "LinearElasticAxisym2DLaw"
        entry["Material"]["Variables"]["THICKNESS"] = 1.0
    write_case("contact_2d/hertz_spheres" + variant.name, "Two pressed spheres of unlike stiffness touch as Hertz says.",
               f"Half-spaces touch on a circle of radius {half:.5f} m under the peak {peak:.5e} Pa; strains reach {0.1 * variant.length:g}, which Hertz neglects.",
               parameters("mesh", settings, constraints, loads,
                          [contact_process([("Interface", "Slave")], advance_ALM_parameters={"use_scale_factor": False},
                                           alternative_formulations={"axisymmetric": True})],
                          [json_output("slave.json", ["LAGRANGE_MULTIPLIER_CONTACT_PRESSURE", "DISPLACEMENT"], "Slave")]),
               materials, mesh, checks)


def write():
    cattaneo_mindlin(Variant(), (0.03, 0.06))
    hertz_spheres(Variant(), 0.07)
    # under light loads the closed forms are exact enough for the error of the mesh to show
    cattaneo_mindlin(Variant("_light", 1e-2, 0.1), (0.03, 0.06))
    cattaneo_mindlin(Variant("_light_coarse", 1e-2, 0.1, 2.5), (0.06, 0.12))
    cattaneo_mindlin(Variant("_light_coarse", 1e-2, 0.1, 2.5), (0.06, 0.12), "Penalty", (1.25, 1.625, 2.0))
    hertz_spheres(Variant("_light", 1e-3, 0.1), 0.03)
    hertz_spheres(Variant("_light_coarse", 1e-3, 0.1, 2.5), 0.06)
