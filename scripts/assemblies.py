"""Decks of the objects of assemblies, which scripts/pictures.py runs and draws: couplings, resultants, supports along a direction,
cyclic symmetry, orthotropic axes, and a bolt that is tightened. Lengths are in mm, forces in N."""
import json, math, os, subprocess

from lib.model import STRUCTURE, Model, process
from lib.solution import solve

STEEL = (2.1e5, 0.3)


def shaft(m, steel=True, element="SmallDisplacementElement"):
    """A tube of 120 mm along z, fixed at z = 0."""
    around = lambda r, t, z: (r * math.cos(t), r * math.sin(t), z)
    body = m.box("Shaft", "3D8N", [3, 36, 24], [8.0, 0.0, 0.0], [16.0, 2 * math.pi, 120.0], around, wrap="y", element=element)
    if steel:
        m.material(body, "3d", *STEEL)
    m.fix(body.side_nodes["z0"], x=0.0, y=0.0, z=0.0)
    return body


def coupled(kind, force, moment):
    """The free end of the shaft coupled to a reference node on the axis, 60 mm beyond it, with a force and a moment there."""
    m = Model(3)
    body = shaft(m)
    end = m.part(body.side_nodes["z1"], body.conditions("z1", "SurfaceLoad"))
    m.processes.append(("constraints", process(kind, {
        "model_part_name": "Structure." + end, "reference_model_part_name": "Structure.Reference", "reference_point": [0.0, 0.0, 180.0]}, STRUCTURE)))
    for name, value in (("POINT_LOAD", force), ("POINT_MOMENT", moment)):
        m.processes.append(("loads", process("assign_vector_variable_to_conditions_process", {
            "model_part_name": "Structure.Reference", "variable_name": name, "value": value})))
    return m


def resultant():
    """A plate with a remote force over its end."""
    m = Model(3)
    body = m.box("Plate", "3D8N", [40, 4, 10], [0.0, 0.0, 0.0], [200.0, 12.0, 50.0])
    m.material(body, "3d", *STEEL)
    m.fix(body.side_nodes["x0"], x=0.0, y=0.0, z=0.0)
    end = m.part(body.side_nodes["x1"], body.conditions("x1", "SurfaceLoad"))
    m.processes.append(("loads", process("distribute_resultant_on_part_process", {
        "model_part_name": "Structure." + end, "force": [0.0, 0.0, -1000.0], "point": [260.0, 60.0, 25.0]}, STRUCTURE)))
    return m


def slope():
    """A block on rollers that run along a slope of 30°, held by its lower end and pressed from above."""
    m, (sine, cosine) = Model(3), (0.5, math.sqrt(0.75))
    turned = lambda x, y, z: (x * cosine - z * sine, y, x * sine + z * cosine)
    body = m.box("Block", "3D8N", [32, 8, 12], [0.0, 0.0, 0.0], [80.0, 20.0, 30.0], turned)
    m.material(body, "3d", 2e3, 0.4)
    for side, normal in (("z0", [-sine, 0.0, cosine]), ("x0", [cosine, 0.0, sine]), ("y0", [0.0, 1.0, 0.0])):
        m.processes.append(("constraints", process("assign_displacement_along_direction_process", {
            "model_part_name": "Structure." + m.part(body.side_nodes[side]), "direction": normal, "value": 0.0}, STRUCTURE)))
    m.traction(body, "z1", (0.0, 0.0, -40.0), where=lambda p: p[0] * cosine + p[2] * sine > 50.0)
    return m


def sector():
    """A quarter of a wheel, cut along spirals, with a torque on its rim: one side follows the other."""
    m = Model(3)
    around = lambda r, t, z: (r * math.cos(t + 0.012 * (r - 30.0)), r * math.sin(t + 0.012 * (r - 30.0)), z)
    body = m.box("Wheel", "3D8N", [24, 20, 4], [30.0, 0.0, 0.0], [90.0, math.pi / 2, 12.0], around)
    m.material(body, "3d", *STEEL, DENSITY=7.85e-9)
    m.fix(body.side_nodes["x0"], x=0.0, y=0.0, z=0.0)
    sides = [m.part(body.side_nodes[side], body.conditions(side, "Surface")) for side in ("y0", "y1")]
    m.processes.append(("constraints", process("apply_periodic_condition_process", {
        "model_part_name": "Structure", "first_model_part_name": sides[0], "second_model_part_name": sides[1], "variable_names": ["DISPLACEMENT"],
        "transformation_settings": {"rotation_settings": {"center": [0.0, 0.0, 0.0], "axis_of_rotation": [0.0, 0.0, 1.0], "angle_degree": 90.0}}})))
    rim = m.part(body.side_nodes["x1"], body.conditions("x1", "SurfaceLoad"))
    m.processes.append(("loads", process("assign_vector_variable_to_conditions_process", {
        "model_part_name": "Structure." + rim, "variable_name": "SURFACE_LOAD", "value": ["-Y", "X", 0.0]})))
    return m


def wound():
    """A tube wound of fibres around it, under internal pressure, between rigid ends."""
    m = Model(3)
    around = lambda r, t, z: (r * math.cos(t), r * math.sin(t), z)
    body = m.box("Tube", "3D8N", [5, 24, 16], [20.0, 0.0, 0.0], [26.0, math.pi, 80.0], around)
    fibres = {"YOUNG_MODULUS_X": 1e4, "YOUNG_MODULUS_Y": 1e4, "YOUNG_MODULUS_Z": 1.4e5, "POISSON_RATIO_XY": 0.4, "POISSON_RATIO_YZ": 0.02,
              "POISSON_RATIO_XZ": 0.02, "SHEAR_MODULUS_XY": 3.5e3, "SHEAR_MODULUS_YZ": 5e3, "SHEAR_MODULUS_XZ": 5e3}
    m.material(body, "LinearElasticOrthotropic3DLaw", 0.0, **fibres)
    for name in ("YOUNG_MODULUS", "POISSON_RATIO"):
        del m.materials[-1]["Material"]["Variables"][name]
    m.processes.append(("constraints", process("set_cylindrical_local_axes_process", {
        "model_part_name": "Structure.Tube", "cylindrical_generatrix_axis": [0.0, 0.0, 1.0], "cylindrical_generatrix_point": [0.0, 0.0, 0.0]}, STRUCTURE)))
    for side in ("z0", "z1"):
        m.fix(body.side_nodes[side], x=0.0, y=0.0, z=0.0)
    for side in ("y0", "y1"):
        m.fix(body.side_nodes[side], y=0.0)
    m.pressure(body, "x0", 40.0)
    return m


MODELS = {
    "kinematic_coupling": lambda: coupled("kinematic_coupling_process", [0.0, 0.0, 0.0], [0.0, 0.0, 1e6]),
    "distributing_coupling": lambda: coupled("distributing_coupling_process", [500.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
    "resultant": resultant,
    "slope": slope,
    "cyclic_sector": sector,
    "orthotropic_tube": wound,
}


def bolt(program, folder):
    """Two plates that a bolt clamps: half of them, meshed by Gmsh. The deck is that of `zelus new` with the process of the bolt."""
    import gmsh
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    o = gmsh.model.occ
    half = lambda shape: o.intersect([(3, shape)], [(3, o.addBox(-50, 0, -50, 100, 50, 100))])[0][0][1]
    plates = [o.addCylinder(0, 0, low, 0, 0, 12, 22) for low in (-12, 0)]
    plates = [half(o.cut([(3, plate)], [(3, o.addCylinder(0, 0, -20, 0, 0, 40, 6.6))])[0][0][1]) for plate in plates]
    parts = [(3, o.addCylinder(0, 0, -12, 0, 0, 24, 6)), (3, o.addCylinder(0, 0, 12, 0, 0, 8, 10)), (3, o.addCylinder(0, 0, -20, 0, 0, 8, 10))]
    shank = half(o.fuse(parts[:1], parts[1:])[0][0][1])
    o.synchronize()
    faces = lambda volume: [s for _, s in gmsh.model.getBoundary([(3, volume)], oriented=False)]
    at = lambda volume, test: [s for s in faces(volume) if test(o.getCenterOfMass(2, s), gmsh.model.getBoundingBox(2, s))]
    is_level = lambda height: lambda c, box: abs(box[5] - box[2]) < 1e-3 and abs(c[2] - height) < 1e-3
    groups = [("Lower", 3, [plates[0]]), ("Upper", 3, [plates[1]]), ("Bolt", 3, [shank]),
              ("Head", 2, at(shank, is_level(12))), ("Nut", 2, at(shank, is_level(-12))),
              ("UpperTop", 2, at(plates[1], is_level(12))), ("LowerBottom", 2, at(plates[0], is_level(-12))),
              ("UpperJoint", 2, at(plates[1], is_level(0))), ("LowerJoint", 2, at(plates[0], is_level(0))),
              ("Symmetry", 2, [s for volume in (*plates, shank) for s in at(volume, lambda c, box: abs(box[4] - box[1]) < 1e-3 and abs(c[1]) < 1e-3)]),
              *((name, 2, at(plate, lambda c, box: box[3] > 21.9 and box[5] - box[2] > 11.9 and box[4] - box[1] > 1.0))
                for name, plate in zip(("LowerRim", "UpperRim"), plates)),
              ("HeadTop", 2, at(shank, is_level(20)))]
    for name, dim, tags in groups:
        gmsh.model.addPhysicalGroup(dim, tags, name=name)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 2.2)
    gmsh.model.mesh.generate(3)
    gmsh.write(os.path.join(folder, "bolt.msh"))
    gmsh.finalize()
    new = [program, "new", "--from", "bolt.msh", "--fix", "LowerRim", "--fix", "UpperRim=x", "--fix", "HeadTop=x",
           "--fix", "Symmetry=y", "--material", "steel", "-o", "deck"]
    done = subprocess.run(new, cwd=folder, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stdout + done.stderr)
    path = os.path.join(folder, "deck", "ProjectParameters.json")
    with open(path) as file:
        deck = json.loads("".join(line.split("//")[0] for line in file))
    deck["processes"]["bolts"] = [process("bolt_pretension_process", {
        "model_part_name": "Structure.Bolt", "point": [0.0, 0.0, 0.3], "normal": [0.0, 0.0, 1.0], "force": "10000.0*t"}, STRUCTURE)]
    with open(path, "w") as file:
        json.dump(deck, file)
    return os.path.join(folder, "deck")


def write(name, program, folder):
    """Writes and runs the model of a name; its folder."""
    solve(MODELS[name](), "ALM", keep=folder)
    return folder
