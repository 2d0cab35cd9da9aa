"""Decks of the objects of assemblies, which scripts/pictures.py runs and draws: couplings, rigid bodies, resultants, supports, springs to
the ground, clearance, cyclic symmetry, materials, and two meshes of Gmsh. Lengths are in mm, forces in N, masses in t, times in s."""
import json, math, os, subprocess

from lib.model import STRUCTURE, Model, process
from lib.solution import solve

STEEL = (2.1e5, 0.3)


def tube(m, **variables):
    """A tube of 120 mm along z."""
    around = lambda r, t, z: (r * math.cos(t), r * math.sin(t), z)
    body = m.box("Shaft", "3D8N", [3, 36, 24], [8.0, 0.0, 0.0], [16.0, 2 * math.pi, 120.0], around, wrap="y")
    m.material(body, "3d", *STEEL, **variables)
    return body


def shaft(m, **variables):
    """The tube, fixed at z = 0."""
    body = tube(m, **variables)
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


def flywheel():
    """A disc that turns at first by 150 rad/s, on the end of a shaft that holds it; the last step is that of the largest twist."""
    m = Model(3)
    body = shaft(m, DENSITY=7.85e-9)
    around = lambda r, t, z: (r * math.cos(t), r * math.sin(t), z)
    disc = m.box("Disc", "3D8N", [3, 36, 2], [16.0, 0.0, 112.0], [45.0, 2 * math.pi, 128.0], around, wrap="y")
    m.material(disc, "3d", *STEEL)
    whole = m.part([*disc.nodes, *body.side_nodes["z1"]])
    m.processes.append(("constraints", process("kinematic_coupling_process", {
        "model_part_name": "Structure." + whole, "reference_model_part_name": "Structure.Reference", "reference_point": [0.0, 0.0, 120.0],
        "mass": 7e-4, "centre_of_mass": [0.0, 0.0, 120.0], "inertia": [0.414, 0.414, INERTIA]}, STRUCTURE)))
    for name, value, interval in (("ANGULAR_VELOCITY", [0.0, 0.0, 150.0], [0.0, 0.0]), ("ROTATION", [0.0, 0.0, None], [0.0, "End"])):
        m.processes.append(("constraints", process("assign_vector_variable_process", {
            "model_part_name": "Structure.Reference", "variable_name": name, "value": value, "interval": interval,
            "constrained": [False, False, False] if name == "ANGULAR_VELOCITY" else [True, True, False]})))
    return m


def rings():
    """Two rings whose meshes just fit, the inner one larger by 0.02 mm on its radius by number: half of them."""
    m = Model(3)
    around = lambda r, t, z: (r * math.cos(t), r * math.sin(t), z)
    inner = m.box("Inner", "3D8N", [8, 48, 6], [12.0, 0.0, 0.0], [20.0, math.pi, 12.0], around)
    outer = m.box("Outer", "3D8N", [10, 48, 6], [20.0, 0.0, 0.0], [30.0, math.pi, 12.0], around)
    for body in (inner, outer):
        m.material(body, "3d", *STEEL)
        m.fix([*body.side_nodes["y0"], *body.side_nodes["y1"]], y=0.0)
        m.fix([*body.side_nodes["z0"], *body.side_nodes["z1"]], z=0.0)
        m.fix([i for i in body.nodes if abs(m.mesh.nodes[i][0]) < 1e-9], x=0.0)
    m.interface((outer, "x0"), (inner, "x1"))
    slave, master = "Structure.Slave0", "Structure." + m.part(inner.side_nodes["x1"], inner.conditions("x1", "Surface"))
    m.processes.append(("constraints", process("initial_clearance_process", {
        "model_part_name": slave, "master_model_part_name": master, "clearance": -0.02})))
    return m


def bedded():
    """A slab on springs to the ground at each of its lower nodes, with a load over a part of it."""
    m = Model(3)
    body = m.box("Slab", "3D8N", [25, 25, 2], [0.0, 0.0, 0.0], [2000.0, 2000.0, 150.0])
    m.material(body, "3d", 3e4, 0.2)
    m.processes.append(("constraints", process("assign_ground_springs_process", {
        "model_part_name": "Structure." + m.part(body.side_nodes["z0"]), "stiffness": [64.0, 64.0, 320.0]}, STRUCTURE)))
    m.traction(body, "z1", (0.0, 0.0, -1.0), where=lambda p: 1200.0 < p[0] < 1600.0 and 1200.0 < p[1] < 1600.0)
    return m


def in_bore():
    """A tube whose first 40 mm stand in a bore, held around and along its axis at its end, with a force across its other end."""
    m = Model(3)
    body = tube(m)
    end, bore = body.side_nodes["z0"], [i for i in body.side_nodes["x1"] if m.mesh.nodes[i][2] < 40.1]
    for nodes, direction in ((bore, "radial"), (end, "axial"), (end, "tangential")):
        m.processes.append(("constraints", process("assign_displacement_along_direction_process", {
            "model_part_name": "Structure." + m.part(nodes), "direction": direction, "origin": [0.0, 0.0, 0.0], "axis": [0.0, 0.0, 1.0],
            "value": 0.0}, STRUCTURE)))
    m.traction(body, "z1", (8.0, 0.0, 0.0))
    return m


def strap(law, **variables):
    """A quarter of a strap of 100 by 40 mm with a hole of 20 mm, 6 mm thick; its pulled end has the traction that a model asks for."""
    m = Model(3)
    edge = lambda a: (50.0, 50.0 * math.tan(a)) if a < math.atan2(20.0, 50.0) else (20.0 / math.tan(a), 20.0)
    def between(s, a, z):
        (x, y), c = edge(a), (10.0 * math.cos(a), 10.0 * math.sin(a))
        return (c[0] + s * (x - c[0]), c[1] + s * (y - c[1]), z)
    corner = math.atan2(20.0, 50.0)
    angles = [corner * k / 8 for k in range(9)] + [corner + (math.pi / 2 - corner) * k / 16 for k in range(1, 17)]
    body = m.graded("Strap", "3D8N", [[(k / 14) ** 1.4 for k in range(15)], angles, [0.0, 1.5, 3.0]], between, element="SmallDisplacementBbarElement")
    m.material(body, law, 2e5, 0.3, **variables)
    m.fix(body.side_nodes["y0"], y=0.0)
    m.fix(body.side_nodes["y1"], x=0.0)
    m.fix(body.side_nodes["z0"], z=0.0)
    return m, body


def hardened():
    """A strap that yields at its hole under 160 MPa and is unloaded again, with the back stress of Armstrong and Frederick."""
    m, body = strap("SmallStrainKinematicPlasticity3DVonMisesVonMises", YIELD_STRESS=250.0, KINEMATIC_HARDENING_TYPE=1,
                    KINEMATIC_PLASTICITY_PARAMETERS=[2e4, 200.0], HARDENING_CURVE=3)
    m.traction(body, "x1", (160.0, 0.0, 0.0), "1 - abs(t - 1)", where=lambda p: p[0] > 49.9)
    return m


def crept():
    """A strap that creeps for 1,000 hours under 60 MPa."""
    m, body = strap("SmallStrainNortonCreep3D", NORTON_COEFFICIENT=1e-14, NORTON_EXPONENT=4.0)
    m.traction(body, "x1", (60.0, 0.0, 0.0), "1", where=lambda p: p[0] > 49.9)
    return m


INERTIA = 0.8  # t mm², about the axis of the disc of `flywheel`
TWIST = math.pi / 2 * math.sqrt(INERTIA * 120.0 / (2.1e5 / 2.6 * math.pi / 2 * (16.0 ** 4 - 8.0 ** 4)))  # time from rest to the largest twist

MODELS = {
    "kinematic_coupling": lambda: coupled("kinematic_coupling_process", [0.0, 0.0, 0.0], [0.0, 0.0, 1e6]),
    "distributing_coupling": lambda: coupled("distributing_coupling_process", [500.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
    "resultant": resultant,
    "slope": slope,
    "cyclic_sector": sector,
    "orthotropic_tube": wound,
    "rigid_body": flywheel,
    "clearance": rings,
    "ground_springs": bedded,
    "cylindrical_support": in_bore,
    "hardening": hardened,
    "creep": crept,
}
# Name: how the model is solved where one step of a static analysis does not do.
STEPS = {
    "rigid_body": {"steps": 40, "end": TWIST, "dynamic": {"time_integration_method": "implicit", "scheme_type": "bossak"}},
    "hardening": {"steps": 20, "end": 2.0},
    "creep": {"steps": 50, "end": 1000.0},
}


def start_gmsh():
    import gmsh
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    return gmsh, gmsh.model.occ


def new_deck(gmsh, program, folder, size, options, **processes):
    """Meshes the model of Gmsh with cells of a size; the folder of the deck that `zelus new` makes of it, with further processes."""
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.model.mesh.generate(3)
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
    gmsh.model.mesh.setOrder(processes.pop("order", 1))
    gmsh.write(os.path.join(folder, "mesh.msh"))
    gmsh.finalize()
    done = subprocess.run([program, "new", "--from", "mesh.msh", "--material", "steel", "-o", "deck", *options.split()],
                          cwd=folder, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stdout + done.stderr)
    path = os.path.join(folder, "deck", "ProjectParameters.json")
    with open(path) as file:
        deck = json.loads("".join(line.split("//")[0] for line in file))
    deck["processes"].update(processes)
    with open(path, "w") as file:
        json.dump(deck, file)
    return os.path.join(folder, "deck")


def faces_of(gmsh, volume, wanted=lambda centre, box: True):
    """The faces of a volume by their centre and their box."""
    faces = [face for _, face in gmsh.model.getBoundary([(3, volume)], oriented=False)]
    return [face for face in faces if wanted(gmsh.model.occ.getCenterOfMass(2, face), gmsh.model.getBoundingBox(2, face))]


def bolt(program, folder):
    """Two plates that a bolt clamps: half of them. The deck is that of `zelus new` with the process of the bolt."""
    gmsh, o = start_gmsh()
    half = lambda shape: o.intersect([(3, shape)], [(3, o.addBox(-50, 0, -50, 100, 50, 100))])[0][0][1]
    plates = [o.addCylinder(0, 0, low, 0, 0, 12, 22) for low in (-12, 0)]
    plates = [half(o.cut([(3, plate)], [(3, o.addCylinder(0, 0, -20, 0, 0, 40, 6.6))])[0][0][1]) for plate in plates]
    parts = [(3, o.addCylinder(0, 0, -12, 0, 0, 24, 6)), (3, o.addCylinder(0, 0, 12, 0, 0, 8, 10)), (3, o.addCylinder(0, 0, -20, 0, 0, 8, 10))]
    shank = half(o.fuse(parts[:1], parts[1:])[0][0][1])
    o.synchronize()
    at = lambda volume, wanted: faces_of(gmsh, volume, wanted)
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
    fixed = "--fix LowerRim --fix UpperRim=x --fix HeadTop=x --fix Symmetry=y"
    return new_deck(gmsh, program, folder, 2.2, fixed, bolts=[process("bolt_pretension_process", {
        "model_part_name": "Structure.Bolt", "point": [0.0, 0.0, 0.3], "normal": [0.0, 0.0, 1.0], "force": "10000.0*t"}, STRUCTURE)])


def ball_stud(program, folder):
    """A ball with a shank, half of it: the ball is held along the normal of its sphere, the end of the shank is guided."""
    gmsh, o = start_gmsh()
    ball, shank = o.addSphere(0, 0, 0, 12), o.addCylinder(0, 0, 0, 0, 0, 60, 6)
    stud = o.fuse([(3, ball)], [(3, shank)])[0]
    stud = o.intersect(stud, [(3, o.addBox(-50, 0, -50, 100, 50, 120))])[0][0][1]
    socket = o.fragment([(3, stud)], [(3, o.addBox(-50, -50, -50, 100, 100, 53))], removeTool=True)[0]
    keep = [tag for _, tag in socket if o.getCenterOfMass(3, tag)[1] > 0 and o.getMass(3, tag) < 1e5]
    o.remove([volume for volume in o.getEntities(3) if volume[1] not in keep], recursive=True)
    o.synchronize()
    of_all = lambda wanted: sorted({face for volume in keep for face in faces_of(gmsh, volume, wanted)})
    is_round = lambda c, box: box[2] < -11.9 and box[5] < 3.1 and box[4] > 11.0
    groups = [("Stud", 3, keep), ("Ball", 2, of_all(is_round)), ("End", 2, of_all(lambda c, box: box[2] > 59.9)),
              ("Symmetry", 2, of_all(lambda c, box: box[4] < 1e-3)),
              ("Shank", 2, of_all(lambda c, box: box[2] > 5.0 and box[5] > 59.9 and box[2] < 20.0 and box[4] > 5.0))]
    for name, dim, tags in groups:
        gmsh.model.addPhysicalGroup(dim, tags, name=name)
    support = process("assign_displacement_along_direction_process", {
        "model_part_name": "Structure.Ball", "direction": "spherical", "origin": [0.0, 0.0, 0.0], "value": 0.0}, STRUCTURE)
    return new_deck(gmsh, program, folder, 2.0, "--fix End=x --fix Symmetry=y --load Shank=1000N,x", order=2, sockets=[support])


def ear(program, folder):
    """A plate of hexahedra that carries an ear of tetrahedra, with pyramids between them, all of second order."""
    gmsh, o = start_gmsh()
    stations = ([-30, -10, 10, 30], [-20, -10, 10, 20])
    plates = [o.addBox(x, y, 0, x_end - x, y_end - y, 8) for x, x_end in zip(stations[0], stations[0][1:])
              for y, y_end in zip(stations[1], stations[1][1:])]
    upper = o.cut([(3, o.addBox(-10, -10, 8, 20, 20, 18))], [(3, o.addCylinder(-20, 0, 18, 40, 0, 0, 5))])[0]
    o.fragment([(3, plate) for plate in plates], upper)
    o.synchronize()
    volumes = [tag for _, tag in gmsh.model.getEntities(3)]
    lower = [tag for tag in volumes if o.getCenterOfMass(3, tag)[2] < 8]
    for volume in lower:
        for face in faces_of(gmsh, volume):
            for _, edge in gmsh.model.getBoundary([(2, face)], oriented=False):
                gmsh.model.mesh.setTransfiniteCurve(edge, round(o.getMass(1, edge) / 2.5) + 1)
            gmsh.model.mesh.setTransfiniteSurface(face)
            gmsh.model.mesh.setRecombine(2, face)
        gmsh.model.mesh.setTransfiniteVolume(volume)
    of_all = lambda volumes, wanted: [face for volume in volumes for face in faces_of(gmsh, volume, wanted)]
    bore = [face for face in of_all(set(volumes) - set(lower), lambda c, box: True) if gmsh.model.getType(2, face) == "Cylinder"]
    for name, dim, tags in (("Ear", 3, volumes), ("Base", 2, of_all(lower, lambda c, box: c[2] < 1e-6)), ("Bore", 2, bore)):
        gmsh.model.addPhysicalGroup(dim, tags, name=name)
    return new_deck(gmsh, program, folder, 2.5, "--fix Base --load Bore=4000N,z --load Bore=3000N,y", order=2)


GMSH = {"bolt": bolt, "spherical_support": ball_stud, "pyramids": ear}


def write(name, program, folder):
    """Writes and runs the model of a name; its folder."""
    solve(MODELS[name](), "ALM", keep=folder, **STEPS.get(name, {}))
    return folder
