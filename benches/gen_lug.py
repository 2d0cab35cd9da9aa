#!/usr/bin/env python3
"""Write a pin in the eye of a lug, drawn by Gmsh, as a deck and as a file of CalculiX.

    gen_lug.py FOLDER [--size 1.0] [--order 1] [--motion 0.05] [--steps 4] [--zelus PATH] [--solver NAME]

The lug is a plate of 12 mm with a round head and a hole of 20 mm; the pin fills the hole without clearance and stands out by 6 mm on both
sides. The far end of the lug is clamped, the ends of the pin move by `--motion` mm along the plate; contact is frictionless. Tetrahedra of
`--order` 1 or 2 have the edge `--size` mm at the contact and four times that far from it. Steel, 210 GPa. Needs the package gmsh of PyPI, and
zelus, whose command `new` makes the deck from the mesh: ProjectParameters.json for the programs that read decks, lug.inp for CalculiX (contact
from surface to surface). reaction.json has the reactions at the ends of the pin.
"""
import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "tests", "cases"))
from deck import contact_process, fix, json_output, material, parameters, solver  # noqa: E402

RADIUS, THICKNESS, OVERHANG, LENGTH, HALF_HEIGHT = 10.0, 12.0, 6.0, 60.0, 20.0
YOUNG, POISSON = 210000.0, 0.3
# Stress by length of CalculiX' contact: ten times the modulus by the edge of a cell.
STIFFNESS = 10 * YOUNG
# Faces of a tetrahedron as CalculiX numbers them, by corners.
FACES = ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))
# Gmsh's order of the nodes of a tetrahedron of ten nodes, for CalculiX.
SECOND_ORDER = (0, 1, 2, 3, 4, 5, 6, 7, 9, 8)


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--size", type=float, default=1.0)
    parser.add_argument("--order", type=int, choices=(1, 2), default=1)
    parser.add_argument("--motion", type=float, default=0.05)
    parser.add_argument("--steps", type=int, default=4)
    parser.add_argument("--solver", default="", help="linear solver that the deck names")
    parser.add_argument("--zelus", default=os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "target", "release", "zelus"))
    return parser.parse_args()


def draw(gmsh, size, order):
    """The geometry and its mesh, with named parts."""
    occ, mesh = gmsh.model.occ, gmsh.model.mesh
    plate = occ.addBox(-LENGTH, -HALF_HEIGHT, 0, LENGTH, 2 * HALF_HEIGHT, THICKNESS)
    head = occ.addCylinder(0, 0, 0, 0, 0, THICKNESS, HALF_HEIGHT)
    eye = occ.addCylinder(0, 0, -1, 0, 0, THICKNESS + 2, RADIUS)
    blank, _ = occ.fuse([(3, plate)], [(3, head)])
    lug = occ.cut(blank, [(3, eye)])[0][0][1]
    pin = occ.addCylinder(0, 0, -OVERHANG, 0, 0, THICKNESS + 2 * OVERHANG, RADIUS)
    occ.synchronize()
    surfaces = {volume: [tag for _, tag in gmsh.model.getBoundary([(3, volume)], oriented=False)] for volume in (lug, pin)}
    round_ones = lambda volume: [tag for tag in surfaces[volume] if gmsh.model.getType(2, tag) == "Cylinder"]
    # The head is round as well, with the larger radius.
    hole = [tag for tag in round_ones(lug) if gmsh.model.getBoundingBox(2, tag)[3] < RADIUS + 1e-3]
    skin = round_ones(pin)
    parts = {"Lug": (3, [lug]), "Pin": (3, [pin]), "HoleFace": (2, hole), "PinFace": (2, skin),
             "Clamped": (2, [tag for tag in surfaces[lug] if gmsh.model.getBoundingBox(2, tag)[3] < 1e-3 - LENGTH]),
             "PinEnds": (2, [tag for tag in surfaces[pin] if tag not in skin])}
    for name, (dimension, tags) in parts.items():
        gmsh.model.addPhysicalGroup(dimension, tags, name=name)
    distance, size_of = mesh.field.add("Distance"), mesh.field.add("Threshold")
    mesh.field.setNumbers(distance, "SurfacesList", hole + skin)
    for key, value in (("InField", distance), ("SizeMin", size), ("SizeMax", 4 * size), ("DistMin", 1.0), ("DistMax", 15.0)):
        mesh.field.setNumber(size_of, key, value)
    mesh.field.setAsBackgroundMesh(size_of)
    for key, value in (("MeshSizeExtendFromBoundary", 0), ("ElementOrder", order), ("HighOrderOptimize", order - 1)):
        gmsh.option.setNumber(f"Mesh.{key}", value)
    mesh.generate(3)
    return parts


def calculix(gmsh, parts, order, motion, steps):
    """The text of CalculiX' file."""
    mesh = gmsh.model.mesh
    numbers, places, _ = mesh.getNodes()
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{n}, {places[3 * i]:.12g}, {places[3 * i + 1]:.12g}, {places[3 * i + 2]:.12g}" for i, n in enumerate(numbers)]
    nodes = 4 if order == 1 else 10
    face_of = {}
    for name in ("Lug", "Pin"):
        lines.append(f"*ELEMENT, TYPE=C3D{nodes}, ELSET={name.upper()}")
        for tag in parts[name][1]:
            for ids, own in zip(*mesh.getElements(3, tag)[1:]):
                for at, element in enumerate(ids):
                    cell = [int(n) for n in own[nodes * at:nodes * (at + 1)]]
                    face_of.update({(name, frozenset(cell[c] for c in face)): (element, number + 1) for number, face in enumerate(FACES)})
                    order_of = SECOND_ORDER if order == 2 else range(4)
                    lines.append(f"{element}, " + ", ".join(str(cell[c]) for c in order_of))
    facet = 3 if order == 1 else 6
    for name, body in (("HoleFace", "Lug"), ("PinFace", "Pin")):
        lines.append(f"*SURFACE, NAME={name.upper()}, TYPE=ELEMENT")
        for tag in parts[name][1]:
            for own in mesh.getElements(2, tag)[2]:
                for at in range(len(own) // facet):
                    element, number = face_of[body, frozenset(int(n) for n in own[facet * at:facet * at + 3])]
                    lines.append(f"{element}, S{number}")
    for name in ("Clamped", "PinEnds"):
        lines.append(f"*NSET, NSET={name.upper()}")
        found = sorted({int(n) for tag in parts[name][1] for own in mesh.getElements(2, tag)[2] for n in own})
        lines += [", ".join(str(n) for n in found[at:at + 8]) for at in range(0, len(found), 8)]
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{YOUNG}, {POISSON}", "*SOLID SECTION, ELSET=LUG, MATERIAL=STEEL",
              "*SOLID SECTION, ELSET=PIN, MATERIAL=STEEL", "*SURFACE INTERACTION, NAME=PLAIN",
              "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{STIFFNESS:g}",
              "*CONTACT PAIR, INTERACTION=PLAIN, TYPE=SURFACE TO SURFACE", "PINFACE, HOLEFACE",
              "*STEP, INC=200", "*STATIC", f"{1 / steps}, 1.0, 1e-5, {1 / steps}", "*BOUNDARY", "CLAMPED, 1, 3",
              f"PINENDS, 1, 1, {motion}", "PINENDS, 2, 3", "*NODE PRINT, NSET=PINENDS, TOTALS=ONLY", "RF", "*END STEP"]
    return "\n".join(lines) + "\n"


def main():
    options = parse()
    import gmsh
    os.makedirs(options.folder, exist_ok=True)
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    parts = draw(gmsh, options.size, options.order)
    with open(os.path.join(options.folder, "lug.inp"), "w") as file:
        file.write(calculix(gmsh, parts, options.order, options.motion, options.steps))
    with tempfile.TemporaryDirectory() as scratch:
        drawn, made = os.path.join(scratch, "lug.msh"), os.path.join(scratch, "deck")
        gmsh.write(drawn)
        subprocess.run([options.zelus, "new", "--from", drawn, "-o", made], check=True, stdout=subprocess.DEVNULL)
        shutil.copy(os.path.join(made, "lug.mdpa"), options.folder)
    gmsh.finalize()
    settings = {"linear_solver_settings": {"solver_type": options.solver}} if options.solver else {}
    settings |= {"contact_settings": {"mortar_type": "ALMContactFrictionless"}, "convergence_criterion": "contact_residual_criterion",
                 "residual_relative_tolerance": 1e-4, "max_iteration": 30}
    deck = parameters(
        "lug", solver(3, "lug", 1 / options.steps, **settings),
        [fix("Clamped", 0.0, 0.0, 0.0), fix("PinEnds", f"{options.motion}*t", 0.0, 0.0)],
        contact=[contact_process([], contact_model_part={"0": ["PinFace", "HoleFace"]}, assume_master_slave={"0": ["PinFace"]})],
        outputs=[json_output("reaction.json", ["REACTION"], "PinEnds")])
    materials = [material(name, at + 1, "3d", YOUNG, POISSON) for at, name in enumerate(("Lug", "Pin"))]
    for name, content in (("ProjectParameters", deck), ("StructuralMaterials", {"properties": materials})):
        with open(os.path.join(options.folder, name + ".json"), "w") as file:
            json.dump(content, file, indent=1)
    print(options.folder)


if __name__ == "__main__":
    main()
