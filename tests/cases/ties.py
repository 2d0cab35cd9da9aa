"""Cases of tied unknowns with closed forms: rigid movements, tied meshes, contact by constraints."""
from deck import *
from mesh import Box, Mesh

YOUNG, POISSON = 2.0e9, 0.3
TRACTION = "VECTOR_LAGRANGE_MULTIPLIER"


def rigid_plate(folder, requirement, **settings):
    """A confined block whose top is tied to one node, which carries the whole load."""
    mesh = Mesh()
    box = Box(mesh, "Body", "2D4N", [4, 3], [0.0, 0.0], [1.0, 0.9])
    top = box.side_nodes["y1"]
    mesh.part("Bottom", box.side_nodes["y0"])
    mesh.part("Sides", box.side_nodes["x0"] + box.side_nodes["x1"])
    mesh.part("Plate", top)
    mesh.part("Loaded", [top[1]], (), [mesh.add_condition("PointLoadCondition2D1N", (top[1],))])
    slope = -1.0e6 / oedometer(YOUNG, POISSON)
    rigid = process("impose_rigid_movement_process",
                    {"model_part_name": "Plate", "master_variable_name": "DISPLACEMENT_Y", "interval": [0.0, "End"]},
                    KRATOS + ".StructuralMechanicsApplication")
    write_case(folder, requirement, "The answer is affine; the tolerance is that of the solution of the equations.",
               parameters("mesh", solver(2, "mesh", **settings), [fix("Bottom", y=0.0), fix("Sides", x=0.0), rigid],
                          [condition_load("Loaded", "POINT_LOAD", 1.0e6, [0.0, -1.0, 0.0])],
                          outputs=[json_output("results.json", ["DISPLACEMENT"])]),
               [material("Body", 1, "strain", YOUNG, POISSON)], mesh, affine_checks([[0.0] * 4, [0.0, 0.0, slope, 0.0]], 1e-10))


def tied_column(folder, requirement, lower, upper, slave="upper", rise=0.25, process_name="mesh_tying_process", **more):
    """A column cut by a sloped interface of unlike meshes, pressed by a displacement; its sides are free."""
    dim = int(lower[0][0])
    up, last, size = "xyz"[dim - 1], dim - 1, [1.0, 0.8][:dim - 1]
    mesh, height, strain = Mesh(), 0.5, 1.0e-3

    def below(*p):
        return (*p[:last], p[last] * (height + rise * p[0]))

    def above(*p):
        at = height + rise * p[0]
        return (*p[:last], at + (p[last] - 1.0) * (1.4 - at))
    low = Box(mesh, "Lower", lower[0], [lower[1]] * (dim - 1) + [2], [0.0] * dim, size + [1.0], below)
    top = Box(mesh, "Upper", upper[0], [upper[1]] * (dim - 1) + [2], [0.0] * (dim - 1) + [1.0], size + [2.0], above)
    sides = {"lower": (low, up + "1"), "upper": (top, up + "0")}
    family = "Line" if dim == 2 else "Surface"
    ids = {name: box.conditions(side, family) for name, (box, side) in sides.items()}
    mesh.part("Slave", sides[slave][0].side_nodes[sides[slave][1]], (), ids[slave])
    mesh.part("Interface", low.side_nodes[up + "1"] + top.side_nodes[up + "0"], (), ids["lower"] + ids["upper"])
    mesh.part("Bottom", low.side_nodes[up + "0"])
    mesh.part("Top", top.side_nodes[up + "1"])
    origin = [i for i in low.side_nodes[up + "0"] if all(c == 0.0 for c in mesh.nodes[i])]
    corner = [i for i in low.side_nodes[up + "0"] if mesh.nodes[i] == (1.0, 0.0, 0.0)]
    mesh.part("Origin", origin)
    mesh.part("Corner", corner)
    constraints = [fix("Bottom", **{up: 0.0}), fix("Top", **{up: -strain * 1.4}),
                   fix("Origin", **{axis: 0.0 for axis in "xyz"[:last]})]
    if dim == 3:
        constraints.append(fix("Corner", y=0.0))
    across = POISSON / (1.0 - POISSON) if dim == 2 else POISSON
    stiffness = YOUNG / (1.0 - POISSON ** 2) if dim == 2 else YOUNG
    fields = []
    for d in range(dim):
        field = [0.0] * 4
        field[d + 1] = -strain if d == last else strain * across
        fields.append(field)
    checks = affine_checks(fields, 1e-10)
    outputs = [json_output("results.json", ["DISPLACEMENT"])]
    if process_name == "mesh_tying_process":
        # all bodies have one Young modulus, so the scale factor only needs the sizes
        h = mesh.nodal_h()
        mean = []
        for box, side in sides.values():
            total = sum(mesh.facet_size(f) for f in box.facets[side])
            mean.append(sum(mesh.facet_size(f) * sum(h[i] for i in f) / len(f) for f in box.facets[side]) / total)
        k = min(YOUNG / m for m in mean)
        pressed = stiffness * strain / (1.0 + rise ** 2) ** 0.5 / k
        value = -pressed if slave == "upper" else pressed
        outputs.append(json_output("slave.json", [TRACTION], "Slave"))
        checks.append(check(f"{TRACTION}_{up.upper()}", 1e-9 * pressed, "slave.json", value=value))
        checks.append(check(f"{TRACTION}_X", 1e-9 * pressed, "slave.json", value=0.0))
        settings = contact_solver(dim, "mesh", mortar="ComponentsMeshTying")
        parts = {"mesh_tying_model_part": {"0": ["Interface"]}}
    else:
        settings = solver(dim, "mesh", mpc_contact_settings={"contact_type": "MeshTying"})
        parts = {"contact_model_part": {"0": ["Interface"]}, "contact_type": "MeshTying"}
    tie = process(process_name, {"model_part_name": "Structure", **parts, "assume_master_slave": {"0": ["Slave"]}, **more}, CONTACT)
    law = "3d" if dim == 3 else "strain"
    write_case(folder, requirement, "Stress is uniform and displacement affine, which the tie must reproduce; the tolerance is "
               "that of the solution of the equations.",
               parameters("mesh", settings, constraints, (), [tie], outputs),
               [material("Lower", 1, law, YOUNG, POISSON), material("Upper", 2, law, YOUNG, POISSON)], mesh, checks)


def pressed_and_opened(folder, requirement, shape, divisions):
    """Two confined blocks of like meshes, pressed onto each other, pulled apart and pressed again, by constraints."""
    dim = int(shape[0])
    up, last, size = "xyz"[dim - 1], dim - 1, [1.0, 0.8][:dim - 1]
    lower, upper = (2.0e9, 0.3), (1.0e9, 0.2)
    mesh = Mesh()
    count = [divisions] * (dim - 1) + [2]
    low = Box(mesh, "Lower", shape, count, [0.0] * dim, size + [1.0])
    top = Box(mesh, "Upper", shape, count, [0.0] * (dim - 1) + [1.0], size + [2.0])
    family = "Line" if dim == 2 else "Surface"
    slave, master = top.conditions(up + "0", family), low.conditions(up + "1", family)
    mesh.part("Slave", top.side_nodes[up + "0"], (), slave)
    mesh.part("Interface", low.side_nodes[up + "1"] + top.side_nodes[up + "0"], (), slave + master)
    mesh.part("Bottom", low.side_nodes[up + "0"])
    mesh.part("Top", top.side_nodes[up + "1"])
    constraints = [fix("Bottom", **{up: 0.0}), fix("Top", **{up: "-0.01*cos(pi*(t - 1))"})]
    for axis in "xyz"[:last]:
        ids = set()
        for box in (low, top):
            ids.update(box.side_nodes[axis + "0"] + box.side_nodes[axis + "1"])
        constraints.append(fix(mesh.part("Sides" + axis.upper(), ids), **{axis: 0.0}))
    m1, m2 = oedometer(*lower), oedometer(*upper)
    checks = []
    for time, moved in ((1.0, -0.01), (2.0, 0.01), (3.0, -0.01)):
        pressure = max(0.0, -moved) / (1.0 / m1 + 1.0 / m2)
        low_field, top_field = [0.0] * 4, [0.0] * 4
        low_field[last + 1] = -pressure / m1
        top_field[last + 1] = -pressure / m2
        top_field[0] = moved + 2.0 * pressure / m2
        for box, field in ((low, low_field), (top, top_field)):
            checks.append(check("DISPLACEMENT_" + up.upper(), 1e-12, f"{box.name.lower()}.json", affine=field, time=time))
    contact = process("mpc_contact_process",
                      {"model_part_name": "Structure", "contact_model_part": {"0": ["Interface"]},
                       "assume_master_slave": {"0": ["Slave"]}}, CONTACT)
    law = "3d" if dim == 3 else "strain"
    write_case(folder, requirement, "The confined stack has uniform pressure and affine displacement; the tolerance is that of "
               "the solution of the equations.",
               parameters("mesh", solver(dim, "mesh", mpc_contact_settings={"contact_type": "Frictionless"}), constraints, (),
                          [contact], [json_output("lower.json", ["DISPLACEMENT"], "Lower"),
                                      json_output("upper.json", ["DISPLACEMENT"], "Upper")], 3.0),
               [material("Lower", 1, law, *lower), material("Upper", 2, law, *upper)], mesh, checks)


def mapped_field(folder, requirement):
    """An affine temperature of one surface reaches the unlike surface it lies on."""
    mesh = Mesh()
    low = Box(mesh, "Lower", "2D4N", [3, 2], [0.0, 0.0], [1.0, 1.0])
    top = Box(mesh, "Upper", "2D4N", [5, 2], [0.0, 1.0], [1.0, 2.0])
    mesh.part("Origin", low.side_nodes["y1"], (), low.conditions("y1", "Line"))
    mesh.part("Destination", top.side_nodes["y0"], (), top.conditions("y0", "Line"))
    mesh.part("Held", low.nodes + top.nodes)
    give = process("assign_vector_variable_process", {
        "model_part_name": "Structure.Origin", "variable_name": "VOLUME_ACCELERATION", "constrained": [False] * 3,
        "value": ["2.0 + 3.0*X", 0.0, 0.0], "interval": [0.0, "End"]})
    carry = process("simple_mortar_mapper_process", {
        "origin_model_part_name": "Structure.Origin", "destination_model_part_name": "Structure.Destination",
        "origin_variable": "VOLUME_ACCELERATION_X"}, CONTACT)
    write_case(folder, requirement, "Mortar mapping reproduces affine fields; the tolerance is round-off.",
               parameters("mesh", solver(2, "mesh"), [fix("Held", x=0.0, y=0.0), give, carry],
                          outputs=[json_output("results.json", ["VOLUME_ACCELERATION"], "Destination")]),
               [material("Lower", 1, "strain", YOUNG, POISSON), material("Upper", 2, "strain", YOUNG, POISSON)], mesh,
               [check("VOLUME_ACCELERATION_X", 1e-12, affine=[2.0, 3.0, 0.0, 0.0])])


def write():
    rigid_plate("constraints/rigid_plate", "Nodes tied to one of them move alike, and their loads add up.")
    rigid_plate("constraints/rigid_plate_elimination", "The elimination builder gives the answer of the block builder.",
                block_builder=False)
    tied_column("mesh_tying/quadrilaterals", "Unlike quadrilaterals tied on a slope pass a patch test.", ("2D4N", 3), ("2D4N", 4))
    tied_column("mesh_tying/coarse_slave", "The coarser side as slave passes the same patch test.", ("2D4N", 3), ("2D4N", 5), "lower")
    tied_column("mesh_tying/triangles_on_quadrilaterals", "Triangles tied to quadrilaterals pass a patch test.", ("2D4N", 3), ("2D3N", 4))
    tied_column("mesh_tying/hexahedra", "Unlike hexahedra tied on a slope pass a patch test.", ("3D8N", 2), ("3D8N", 3))
    tied_column("mesh_tying/tetrahedra", "Unlike tetrahedra tied on a slope pass a patch test.", ("3D4N", 2), ("3D4N", 3))
    tied_column("mesh_tying/tetrahedra_on_hexahedra", "Tetrahedra tied to hexahedra pass a patch test.", ("3D8N", 2), ("3D4N", 3))
    tied_column("mesh_tying/hexahedra_on_tetrahedra", "Hexahedra tied to tetrahedra pass a patch test.", ("3D4N", 3), ("3D8N", 2))
    tied_column("mpc/tying_matching", "Constraints that tie matching meshes pass a patch test.", ("2D4N", 3), ("2D4N", 3),
                process_name="mpc_contact_process")
    tied_column("mpc/tying_matching_hexahedra", "Constraints that tie matching hexahedra pass a patch test.", ("3D8N", 2), ("3D8N", 2),
                process_name="mpc_contact_process")
    pressed_and_opened("mpc/pressed_and_opened", "Constraints press, let go and press again.", "2D4N", 3)
    pressed_and_opened("mpc/pressed_and_opened_hexahedra", "Constraints press, let go and press again in space.", "3D8N", 2)
    mapped_field("mpc/mapped_field", "A field is mapped between unlike surfaces.")
