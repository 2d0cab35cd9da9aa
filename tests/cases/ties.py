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
