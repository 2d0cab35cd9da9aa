"""Contact cases with closed forms: stacks of blocks whose pressure is uniform, pressed, opened, sloped, in 2D and 3D.

Confined stacks (rollers on all sides) keep their cross-section, so their closed form is exact for any displacement."""
import json, math, os

from deck import *
from mesh import Box, Mesh

LOWER, UPPER = (2.0e9, 0.3), (1.0e9, 0.2)
LOAD = 1.0e6
MULTIPLIER = "LAGRANGE_MULTIPLIER_CONTACT_PRESSURE"


def scale_factor(mesh, sides):
    """SCALE_FACTOR of the automatic ALM parameters: the smaller of both sides' mean E over mean nodal size.

    `sides` holds (facets, young) of slave and master; both means are weighted with the facet sizes."""
    h = mesh.nodal_h()
    values = []
    for facets, young in sides:
        total = sum(mesh.facet_size(f) for f in facets)
        size = sum(mesh.facet_size(f) * sum(h[i] for i in f) / len(f) for f in facets) / total
        values.append(young / size)
    return min(values)


def roller_parts(mesh, boxes, axes, all_axes=False):
    """One part for each lateral axis with the nodes of both its sides, and the constraints that hold it."""
    out = []
    for axis in axes:
        ids = set()
        for box in boxes:
            ids.update(box.side_nodes[axis + "0"] + box.side_nodes[axis + "1"])
        out.append(fix(mesh.part("Sides" + axis.upper(), ids), **{a: 0.0 for a in (axes if all_axes else axis)}))
    return out


def stack(folder, requirement, lower=("2D4N", 3), upper=("2D4N", 3), slave="upper", conditions=True, drive=None, gap=0.0,
          manual=None, time_step=1.0, end_time=1.0, mortar_kind="Frictionless", why=None, process_settings=None, skew=None,
          multiplier=True, find_skin=False, gaps=True, **settings):
    """Two confined blocks, pressed by LOAD on top or by `drive` {time: displacement of the top}.

    `gaps` writes weighted gaps, which an iterative engine leaves at its tolerance and large motions at their own round-off."""
    dim = int(lower[0][0])
    up, last = "xyz"[dim - 1], dim - 1
    size = [1.0, 0.8][:dim - 1]
    mesh = Mesh()
    divisions = lambda n: (n if isinstance(n, (list, tuple)) else [n] * (dim - 1) + [2])
    low = Box(mesh, "Lower", lower[0], divisions(lower[1]), [0.0] * dim, size + [1.0], skew)
    top = Box(mesh, "Upper", upper[0], divisions(upper[1]), [0.0] * (dim - 1) + [1.0 + gap], size + [2.0 + gap], skew)
    boxes = {"lower": low, "upper": top}
    other = "lower" if slave == "upper" else "upper"
    facing = {"lower": up + "1", "upper": up + "0"}
    family = "Line" if dim == 2 else "Surface"
    ids = {}
    if not find_skin:
        for name, box in boxes.items():
            ids[name] = box.conditions(facing[name], family) if conditions else []
        mesh.part("Slave", boxes[slave].side_nodes[facing[slave]], (), ids[slave])
        mesh.part("Interface", low.side_nodes[up + "1"] + top.side_nodes[up + "0"], (), ids["lower"] + ids["upper"])
    mesh.part("Bottom", low.side_nodes[up + "0"])
    constraints = [fix("Bottom", **{up: 0.0})] + roller_parts(mesh, [low, top], "xyz"[:dim - 1], skew is not None)
    m1, m2 = oedometer(*LOWER), oedometer(*UPPER)
    loads, stresses = [], {}
    if drive is None:
        mesh.part("Top", top.side_nodes[up + "1"], (), top.conditions(up + "1", family + "Load"))
        direction = [0.0] * 3
        direction[last] = -1.0
        loads.append(condition_load("Top", family.upper() + "_LOAD", LOAD, direction))
        stresses[end_time] = (LOAD, 0.0)
    else:
        mesh.part("Top", top.side_nodes[up + "1"])
        expression, at = drive
        constraints.append(fix("Top", **{up: expression}))
        for time, moved in at.items():
            closed = max(0.0, -moved - gap)
            pressure = closed / (1.0 / m1 + 1.0 / m2)
            stresses[time] = (pressure, moved + gap if closed == 0.0 else 0.0)
    k = 1.0
    if manual:
        k = manual["scale_factor"]
    elif multiplier:
        k = scale_factor(mesh, [(boxes[slave].facets[facing[slave]], (UPPER if slave == "upper" else LOWER)[0]),
                                (boxes[other].facets[facing[other]], (UPPER if other == "upper" else LOWER)[0])])
    checks = []
    scale = LOAD / min(m1, m2)
    for time, (pressure, opening) in stresses.items():
        when = {"time": time} if len(stresses) > 1 else {}
        low_field = [0.0] * 4
        low_field[last + 1] = -pressure / m1
        shift = opening - gap
        top_field = [shift - pressure / m1 + pressure / m2 * (1.0 + gap), 0.0, 0.0, 0.0]
        top_field[last + 1] = -pressure / m2
        for box, field in ((low, low_field), (top, top_field)):
            checks.append(check("DISPLACEMENT_" + up.upper(), 1e-7 * scale, f"{box.name.lower()}.json", affine=field, **when))
            for axis in "XYZ"[:dim - 1]:
                checks.append(check("DISPLACEMENT_" + axis, 1e-7 * scale, f"{box.name.lower()}.json", value=0.0, **when))
        if multiplier:
            checks.append(check(MULTIPLIER, 1e-6 * LOAD / k, "slave.json", value=0.0 if pressure == 0.0 else -pressure / k, **when))
    outputs = [json_output("lower.json", ["DISPLACEMENT"], "Lower"), json_output("upper.json", ["DISPLACEMENT"], "Upper")]
    if multiplier:
        outputs.append(json_output("slave.json", [MULTIPLIER] + ["WEIGHTED_GAP"] * gaps, "Slave"))
    more = dict(process_settings or {})
    if manual:
        more["advance_ALM_parameters"] = {"manual_ALM": True, "stiffness_factor": 1.0, "penalty_scale_factor": 1.0,
                                          "use_scale_factor": True, **manual}
    pairs = [] if find_skin else [("Interface", "Slave")]
    law = "3d" if dim == 3 else "strain"
    write_case(folder, requirement,
               why or "The confined stack has uniform pressure and affine displacement, which mortar contact must reproduce; "
                      "the tolerance is that of the iteration.",
               parameters("mesh", contact_solver(dim, "mesh", time_step, **settings), constraints, loads,
                          [contact_process(pairs, mortar_kind, **more)], outputs, end_time),
               [material("Lower", 1, law, *LOWER), material("Upper", 2, law, *UPPER)], mesh, checks)


def slid_past():
    """A block pressed on rigid ground and moved along it in one step, farther than its pairs reach."""
    mesh, pressed, moved = Mesh(), 0.01, 2.0
    low = Box(mesh, "Lower", "2D4N", [10, 1], [0.0, 0.0], [4.0, 1.0])
    top = Box(mesh, "Upper", "2D4N", [4, 2], [0.5, 1.0], [1.5, 2.0])
    slave, master = top.conditions("y0", "Line"), low.conditions("y1", "Line")
    mesh.part("Slave", top.side_nodes["y0"], (), slave)
    mesh.part("Interface", low.side_nodes["y1"] + top.side_nodes["y0"], (), slave + master)
    mesh.part("Ground", low.side_nodes["y0"] + low.side_nodes["y1"])
    mesh.part("Top", top.side_nodes["y1"])
    mesh.part("SidesX", top.side_nodes["x0"] + top.side_nodes["x1"])
    along = f"{moved}*(t-1.0)"
    k = scale_factor(mesh, [(top.facets["y0"], UPPER[0]), (low.facets["y1"], LOWER[0])])
    pressure, checks = oedometer(*UPPER) * pressed, []
    for time, x in ((1.0, 0.0), (2.0, moved)):
        checks.append(check("DISPLACEMENT_X", 1e-7 * pressed, "upper.json", value=x, time=time))
        checks.append(check("DISPLACEMENT_Y", 1e-7 * pressed, "upper.json", affine=[pressed, 0.0, -pressed, 0.0], time=time))
        checks.append(check(MULTIPLIER, 1e-6 * pressure / k, "slave.json", value=-pressure / k, time=time))
    write_case("contact_2d/slid_past", "A block that slides off all its pairs in one step is in contact where it ends.",
               "A confined block on rigid ground has uniform pressure wherever it stands; the tolerance is the iteration's.",
               parameters("mesh", contact_solver(2, "mesh"), [fix("Ground", x=0.0, y=0.0), fix("Top", y=-pressed),
                                                              fix("SidesX", x=along)], (),
                          [contact_process([("Interface", "Slave")])],
                          [json_output("upper.json", ["DISPLACEMENT"], "Upper"),
                           json_output("slave.json", [MULTIPLIER], "Slave")], 2.0),
               [material("Lower", 1, "strain", *LOWER), material("Upper", 2, "strain", *UPPER)], mesh, checks)


def by_another_method(folder, process_name, formulation, **process_settings):
    """Lets the contact of a written case be that of another process and formulation."""
    path = os.path.join(HERE, folder, "ProjectParameters.json")
    with open(path) as file:
        project = json.load(file)
    project["solver_settings"]["contact_settings"]["mortar_type"] = formulation
    contact = project["processes"]["contact_process_list"][0]
    contact["python_module"] = process_name
    contact["Parameters"].update(process_settings)
    with open(path, "w") as file:
        file.write(pretty(project) + "\n")


def three_blocks():
    """Two contact pairs, keys "0" and "1"."""
    mesh = Mesh()
    boxes = [Box(mesh, name, "2D4N", [n, 2], [0.0, z], [1.0, z + 1.0])
             for name, n, z in (("Lower", 3, 0.0), ("Middle", 4, 1.0), ("Upper", 2, 2.0))]
    materials = [(2.0e9, 0.3), (1.0e9, 0.2), (3.0e9, 0.25)]
    pairs = []
    for key in (0, 1):
        slave = boxes[key + 1].conditions("y0", "Line")
        master = boxes[key].conditions("y1", "Line")
        mesh.part(f"Slave{key}", boxes[key + 1].side_nodes["y0"], (), slave)
        mesh.part(f"Interface{key}", boxes[key + 1].side_nodes["y0"] + boxes[key].side_nodes["y1"], (), slave + master)
        pairs.append((f"Interface{key}", f"Slave{key}"))
    mesh.part("Bottom", boxes[0].side_nodes["y0"])
    mesh.part("Top", boxes[2].side_nodes["y1"], (), boxes[2].conditions("y1", "LineLoad"))
    constraints = [fix("Bottom", y=0.0)] + roller_parts(mesh, boxes, "x")
    checks, shift, scale = [], 0.0, LOAD / oedometer(*materials[1])
    for number, (box, values) in enumerate(zip(boxes, materials)):
        slope = -LOAD / oedometer(*values)
        checks.append(check("DISPLACEMENT_Y", 1e-7 * scale, f"{box.name.lower()}.json", affine=[shift - slope * number, 0, slope, 0]))
        shift += slope
    write_case("contact_2d/three_blocks", "Two contact pairs of one process, keys 0 and 1, act together.",
               "A confined stack has uniform pressure and affine displacement; the tolerance is that of the iteration.",
               parameters("mesh", contact_solver(2, "mesh"), constraints,
                          [condition_load("Top", "LINE_LOAD", LOAD, [0.0, -1.0, 0.0])], [contact_process(pairs)],
                          [json_output(f"{b.name.lower()}.json", ["DISPLACEMENT"], b.name) for b in boxes]),
               [material(b.name, i, "strain", *v) for i, (b, v) in enumerate(zip(boxes, materials), 1)], mesh, checks)


def free_sides(folder, lower, upper):
    """Unconfined blocks of one material: the pressed column widens alike on both sides of the interface."""
    dim = int(lower[0][0])
    up, last, size = "xyz"[dim - 1], dim - 1, [1.0, 0.8][:dim - 1]
    young, poisson, load = 2.0e9, 0.3, 2.0e3
    mesh = Mesh()
    low = Box(mesh, "Lower", lower[0], [lower[1]] * (dim - 1) + [2], [0.0] * dim, size + [1.0])
    top = Box(mesh, "Upper", upper[0], [upper[1]] * (dim - 1) + [2], [0.0] * (dim - 1) + [1.0], size + [2.0])
    family = "Line" if dim == 2 else "Surface"
    slave, master = top.conditions(up + "0", family), low.conditions(up + "1", family)
    mesh.part("Slave", top.side_nodes[up + "0"], (), slave)
    mesh.part("Interface", low.side_nodes[up + "1"] + top.side_nodes[up + "0"], (), slave + master)
    mesh.part("Bottom", low.side_nodes[up + "0"])
    mesh.part("Top", top.side_nodes[up + "1"], (), top.conditions(up + "1", family + "Load"))
    constraints = [fix("Bottom", **{up: 0.0})]
    for axis in "xyz"[:dim - 1]:
        part = mesh.part("Symmetry" + axis.upper(), low.side_nodes[axis + "0"] + top.side_nodes[axis + "0"])
        constraints.append(fix(part, **{axis: 0.0}))
    along, across = ((1 - poisson ** 2, -poisson * (1 + poisson)) if dim == 2 else (1.0, -poisson))
    fields = []
    for d in range(dim):
        field = [0.0] * 4
        field[d + 1] = -load / young * (along if d == last else across)
        fields.append(field)
    k = scale_factor(mesh, [(top.facets[up + "0"], young), (low.facets[up + "1"], young)])
    direction = [0.0] * 3
    direction[last] = -1.0
    write_case(folder, "A pressed column cut by a non-matching frictionless interface behaves as if it were whole.",
               "Loads and contact act on the deformed facets, which moves the answer by the strain, 1e-6.",
               parameters("mesh", contact_solver(dim, "mesh", residual_absolute_tolerance=1e-9,
                                                 contact_settings={"contact_residual_absolute_tolerance": 1e-9}), constraints,
                          [condition_load("Top", family.upper() + "_LOAD", load, direction)],
                          [contact_process([("Interface", "Slave")])],
                          [json_output("results.json", ["DISPLACEMENT"]), json_output("slave.json", [MULTIPLIER], "Slave")]),
               [material("Lower", 1, "3d" if dim == 3 else "strain", young, poisson),
                material("Upper", 2, "3d" if dim == 3 else "strain", young, poisson)], mesh,
               affine_checks(fields, 1e-5) + [check(MULTIPLIER, 1e-5 * load / k, "slave.json", value=-load / k)])


def slope(folder, shape, lower, upper, contrast=1.0, rise=0.25):
    """Uniform pressure on a block cut by a sloped interface; the upper part may be `contrast` times stiffer."""
    dim = int(shape[0])
    young, poisson, load = 2.0e9, 0.3, 2.0e3
    mesh = Mesh()
    up, last, size = "xyz"[dim - 1], dim - 1, [1.0, 0.8][:dim - 1]
    height = 0.5

    def below(*p):
        return (*p[:last], p[last] * (height + rise * p[0]))

    def above(*p):
        at = height + rise * p[0]
        return (*p[:last], at + (p[last] - 1.0) * (1.4 - at))
    low = Box(mesh, "Lower", shape, [lower] * (dim - 1) + [2], [0.0] * dim, size + [1.0], below)
    top = Box(mesh, "Upper", shape, [upper] * (dim - 1) + [2], [0.0] * (dim - 1) + [1.0], size + [2.0], above)
    family = "Line" if dim == 2 else "Surface"
    slave, master = top.conditions(up + "0", family), low.conditions(up + "1", family)
    mesh.part("Slave", top.side_nodes[up + "0"], (), slave)
    mesh.part("Interface", low.side_nodes[up + "1"] + top.side_nodes[up + "0"], (), slave + master)
    mesh.part("Bottom", low.side_nodes[up + "0"])
    constraints = [fix("Bottom", **{up: 0.0})]
    pressed, pressed_nodes = top.conditions(up + "1", family + "Load"), set(top.side_nodes[up + "1"])
    for axis in "xyz"[:dim - 1]:
        part = mesh.part("Symmetry" + axis.upper(), low.side_nodes[axis + "0"] + top.side_nodes[axis + "0"])
        constraints.append(fix(part, **{axis: 0.0}))
        for box in (low, top):
            pressed += box.conditions(axis + "1", family + "Load")
            pressed_nodes.update(box.side_nodes[axis + "1"])
    mesh.part("Pressed", pressed_nodes, (), pressed)
    shrink = (1 + poisson) * (1 - 2 * poisson) if dim == 2 else 1 - 2 * poisson
    e1, e2 = -load * shrink / young, -load * shrink / (young * contrast)
    checks = []
    for box, e, shift in ((low, e1, 0.0), (top, e2, (e1 - e2) * height)):
        fields = [[0.0] * 4 for _ in range(dim)]
        for d in range(dim):
            fields[d][d + 1] = e
        fields[last][0] = shift
        checks += affine_checks(fields, 1e-5, results=f"{box.name.lower()}.json")
    k = scale_factor(mesh, [(top.facets[up + "0"], young * contrast), (low.facets[up + "1"], young)])
    checks.append(check(MULTIPLIER, 1e-5 * load / k, "slave.json", value=-load / k))
    law = "3d" if dim == 3 else "strain"
    write_case(folder, "Uniform pressure passes through a sloped, non-matching frictionless interface"
               + ("." if contrast == 1.0 else " of two materials, which slide on it."),
               "Uniform pressure leaves no shear on any plane; loads and contact act on the deformed facets, which moves the "
               "answer by the strain, 1e-6.",
               parameters("mesh", contact_solver(dim, "mesh", residual_absolute_tolerance=1e-9,
                                                 contact_settings={"contact_residual_absolute_tolerance": 1e-9}), constraints,
                          [condition_pressure("Pressed", "NEGATIVE_FACE_PRESSURE" if dim == 2 else "POSITIVE_FACE_PRESSURE", load)],
                          [contact_process([("Interface", "Slave")])],
                          [json_output("lower.json", ["DISPLACEMENT"], "Lower"), json_output("upper.json", ["DISPLACEMENT"], "Upper"),
                           json_output("slave.json", [MULTIPLIER], "Slave")]),
               [material("Lower", 1, law, young, poisson), material("Upper", 2, law, young * contrast, poisson)], mesh, checks)


def tilted_slivers():
    """A column of tetrahedra, turned in space and cut by facets of no common pattern, pressed along its axis."""
    mesh, strain, young = Mesh(), 1.0e-3, 2.0e9
    mesh.digits = 17
    axes = [(2 / 3, 2 / 3, 1 / 3), (-2 / 3, 1 / 3, 2 / 3), (1 / 3, -2 / 3, 2 / 3)]

    def place(wave):
        def turned(x, y, z):
            inside = 16 * x * (1 - x) * y * (1 - y)
            p = (x + 0.06 * inside * math.sin(3.1 * wave * x + 2.5 * y + wave), y + 0.06 * inside * math.cos(2.9 * wave * y + 3 * x), z)
            return tuple(sum(axis[c] * v for axis, v in zip(axes, p)) for c in range(3))
        return turned
    low = Box(mesh, "Lower", "3D4N", [4, 4, 1], [0.0] * 3, [1.0] * 3, place(2))
    top = Box(mesh, "Upper", "3D4N", [5, 5, 1], [0.0, 0.0, 1.0], [1.0, 1.0, 2.0], place(5))
    slave, master = top.conditions("z0", "Surface"), low.conditions("z1", "Surface")
    mesh.part("Slave", top.side_nodes["z0"], (), slave)
    mesh.part("Interface", low.side_nodes["z1"] + top.side_nodes["z0"], (), slave + master)
    mesh.part("Bottom", low.side_nodes["z0"])
    mesh.part("Top", top.side_nodes["z1"])
    fields = [[0.0, *(-strain * axes[2][i] * axes[2][j] for j in range(3))] for i in range(3)]
    write_case("contact_3d/tetrahedra_tilted",
               "Triangles that meet in slivers and lie askew in space pass a constant stress, to round-off.",
               "Without Poisson effect the column stays as wide as it is; positions have 1e-16, and so have lengths between them. With "
               "overlaps below 1e-5 of the slave left out the displacement is off by 2e-9.",
               parameters("mesh", contact_solver(3, "mesh", residual_relative_tolerance=1e-11, residual_absolute_tolerance=1e-12,
                                                 contact_settings={"contact_residual_absolute_tolerance": 1e-12}),
                          [fix("Bottom", 0.0, 0.0, 0.0), fix("Top", *(-2 * strain * c for c in axes[2]))], (),
                          [contact_process([("Interface", "Slave")])], [json_output("results.json", ["DISPLACEMENT"])]),
               [material("Lower", 1, "3d", young, 0.0), material("Upper", 2, "3d", young, 0.0)], mesh,
               affine_checks(fields, 1e-12))


def write():
    flat = "contact_2d/"
    stack(flat + "matching", "Matching quadrilaterals pass a constant-stress patch test.")
    stack(flat + "nonmatching", "Non-matching quadrilaterals pass a constant-stress patch test, the finer side as slave.", upper=("2D4N", 5))
    stack(flat + "nonmatching_coarse_slave", "The coarser side as slave passes the same patch test.", upper=("2D4N", 5), slave="lower")
    # as stiff as the stack: each update of the multipliers halves the penetration
    stiffness = 1.0 / (1.0 / oedometer(*LOWER) + 1.0 / oedometer(*UPPER))
    stack(flat + "uzawa", "Uzawa's iteration leaves no penetration although its kernel is a penalty.",
          drive=("-0.001*t", {1.0: -0.001}), manual={"penalty": stiffness, "scale_factor": 1.0},
          process_settings={"interval": [0.0, "End"]})
    by_another_method(flat + "uzawa", "uzawa_contact_process", "UzawaContactFrictionless",
                      uzawa_parameters={"multiplier_tolerance": 1e-9})
    stack(flat + "triangles", "Non-matching triangles pass a constant-stress patch test.", ("2D3N", 3), ("2D3N", 4))
    stack(flat + "triangles_on_quadrilaterals", "Triangles on quadrilaterals pass a constant-stress patch test.", upper=("2D3N", 4))
    stack(flat + "parts_of_nodes", "Contact parts that list nodes only get their conditions from the elements' faces.",
          upper=("2D4N", 4), conditions=False)
    stack(flat + "skin_detection", "Without any contact part the skin of the model is found and its sides paired.",
          upper=("2D4N", 4), find_skin=True, multiplier=False)
    stack(flat + "manual_parameters", "Manual ALM parameters change the multiplier's unit and not the answer.",
          upper=("2D4N", 4), manual={"penalty": 5.0e8, "scale_factor": 1.0e6})
    stack(flat + "normal_variation", "The derivatives of the normals leave the answer as it is.", upper=("2D4N", 4),
          process_settings={"normal_variation": "nodal_elemental_derivatives"})
    stack(flat + "closing_gap", "An open gap carries nothing; once closed, the pressure follows the remaining displacement.",
          upper=("2D4N", 4), drive=("-0.005*t", {1.0: -0.005, 2.0: -0.010, 4.0: -0.020}), gap=0.0075, end_time=4.0)
    dropped = "A block that falls a long way in one step, with no pairs at its start, comes to rest on the other."
    stack(flat + "dropped", dropped, upper=("2D4N", 4), drive=("-1.02*t", {1.0: -1.02}), gap=1.0, gaps=False)
    stack(flat + "dropped_deep", dropped[:-1] + ", even from deeper in it than a mesh size.", upper=("2D4N", 4),
          drive=("-1.4*t", {1.0: -1.4}), gap=1.0, gaps=False)
    slid_past()
    stack(flat + "opening", "A contact that is pulled apart carries nothing afterwards.",
          upper=("2D4N", 4), drive=("0.01*(2*t - 3)", {1.0: -0.01, 2.0: 0.01}), end_time=2.0)
    for name in ("displacement", "mixed", "and", "or"):
        loose = {f"contact_displacement_{k}_tolerance": v for k, v in (("relative", 1e-9), ("absolute", 1e-12))}
        stack(flat + f"criterion_{name}", f"contact_{name}_criterion ends the iteration at the answer.", upper=("2D4N", 4),
              convergence_criterion=f"contact_{name}_criterion", displacement_relative_tolerance=1e-9,
              displacement_absolute_tolerance=1e-12, contact_settings=loose)
    stack(flat + "criterion_plain", "A criterion without contact in its name is joined with the active set's.", upper=("2D4N", 4),
          convergence_criterion="residual_criterion")
    three_blocks()
    free_sides(flat + "free_sides", ("2D4N", 3), ("2D4N", 4))
    slope(flat + "slope", "2D4N", 3, 4)
    slope(flat + "slope_two_materials", "2D4N", 3, 4, contrast=3.0)
    slope(flat + "slope_triangles", "2D3N", 4, 3)

    solid = "contact_3d/"
    stack(solid + "hexahedra_matching", "Matching hexahedra pass a constant-stress patch test.", ("3D8N", 2), ("3D8N", 2))
    stack(solid + "hexahedra_nonmatching", "Non-matching hexahedra (quad-quad) pass a constant-stress patch test.", ("3D8N", 2), ("3D8N", 3))
    stack(solid + "hexahedra_coarse_slave", "The coarser side as slave passes the same patch test.", ("3D8N", 2), ("3D8N", 3), slave="lower")
    stack(solid + "iterative_engine", "GMRES on condensed multipliers passes the same patch test.", ("3D8N", 2), ("3D8N", 3),
          gaps=False, linear_solver_settings={"solver_type": "gmres", "tolerance": 1e-11})
    stack(solid + "hexahedra_skewed", "Parallelogram facets (quad-quad) pass a constant-stress patch test.", ("3D8N", 2), ("3D8N", 3),
          skew=lambda x, y, z: (x + 0.3 * y, y, z))
    stack(solid + "tetrahedra", "Non-matching tetrahedra (tri-tri) pass a constant-stress patch test.", ("3D4N", 2), ("3D4N", 3))
    stack(solid + "tetrahedra_on_hexahedra", "Triangles as slave on quadrilaterals (tri-quad) pass a constant-stress patch test.",
          ("3D8N", 2), ("3D4N", 3))
    stack(solid + "hexahedra_on_tetrahedra", "Quadrilaterals as slave on triangles (quad-tri) pass a constant-stress patch test.",
          ("3D4N", 2), ("3D8N", 3))
    stack(solid + "prisms", "Non-matching prisms on their triangular faces pass a constant-stress patch test.", ("3D6N", 2), ("3D6N", 3))
    stack(solid + "prisms_on_hexahedra", "Prisms' triangles as slave on hexahedra pass a constant-stress patch test.", ("3D8N", 2), ("3D6N", 3))
    stack(solid + "parts_of_nodes", "Contact parts that list nodes only get their conditions from the elements' faces.",
          ("3D8N", 2), ("3D8N", 3), conditions=False)
    stack(solid + "skin_detection", "Without any contact part the skin of the model is found and its sides paired.",
          ("3D8N", 2), ("3D8N", 3), find_skin=True, multiplier=False)
    stack(solid + "normal_variation", "The derivatives of the normals leave the answer as it is.", ("3D8N", 2), ("3D8N", 3),
          process_settings={"normal_variation": "nodal_elemental_derivatives"})
    stack(solid + "dropped", dropped, ("3D8N", 2), ("3D8N", 3), drive=("-1.02*t", {1.0: -1.02}), gap=1.0, gaps=False)
    stack(solid + "opening", "A contact that is pulled apart carries nothing afterwards.", ("3D8N", 2), ("3D8N", 3),
          drive=("0.01*(2*t - 3)", {1.0: -0.01, 2.0: 0.01}), end_time=2.0)
    free_sides(solid + "free_sides", ("3D8N", 2), ("3D8N", 3))
    slope(solid + "slope", "3D8N", 2, 3)
    slope(solid + "slope_tetrahedra", "3D4N", 2, 3)
    tilted_slivers()
    # coordinates on this slope are not exact in binary: vertices that touch edges must not lose cells of the overlap
    slope(solid + "slope_tetrahedra_round_off", "3D4N", 2, 3, rise=0.3)
