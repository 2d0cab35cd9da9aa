#!/usr/bin/env python3
"""Write one arch that is dragged over another with friction, in plane strain, as a deck and as a file of CalculiX.

    gen_arches.py FOLDER [--cells 4] [--order 1] [--steps 80] [--overlap 1.0] [--travel 6.5] [--friction 0.2] [--solver NAME]

Arches and material are those of `verification/two_arches`: half rings under large displacements (Kirchhoff and Saint-Venant). The feet of the
lower one are clamped. The upper one hangs upside down; it starts left of the lower one, free of it, with its crown `--overlap` below the
lower one's, and its feet move right by `--travel` in equal steps. `--cells` quadrilaterals of four or eight nodes (`--order`) lie through the
thickness; those of the two arches do not match. reaction.json has the reactions of the lower feet. CalculiX (arches.inp, contact from surface
to surface) makes solids of one layer from its cells of plane strain.
"""
import argparse
import json
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "verification"))
from lib.model import Model  # noqa: E402
from deck import json_output  # noqa: E402
from two_arches.case import OUTER, POISSON, YOUNG, half_ring  # noqa: E402

# Cells along an arch for one through its thickness, of the lower and of the upper one.
ALONG = (28, 30)
# Stress by length of CalculiX' contact: ten times the modulus by the thickness; its stick slope is as much.
STIFFNESS = 10 * YOUNG


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--cells", type=int, default=4)
    parser.add_argument("--order", type=int, choices=(1, 2), default=1)
    parser.add_argument("--steps", type=int, default=80)
    parser.add_argument("--overlap", type=float, default=1.0)
    parser.add_argument("--travel", type=float, default=6.5)
    parser.add_argument("--friction", type=float, default=0.2)
    parser.add_argument("--solver", default="", help="linear solver that the deck names")
    return parser.parse_args()


def calculix(model, bodies, feet, options):
    """The input file of CalculiX."""
    mesh, corners = model.mesh, 4  # and faces: n from corner n to the next
    lines = ["*NODE, NSET=ALL"] + [f"{n}, {x:.12g}, {y:.12g}, {z:.12g}" for n, (x, y, z) in mesh.nodes.items()]
    for body in bodies:
        lines.append(f"*ELEMENT, TYPE=CPE{corners * options.order}, ELSET={body.name.upper()}")
        lines += [f"{e}, {', '.join(map(str, cell))}" for e, cell in zip(body.elements, body.cells)]
    for body in bodies:
        lines.append(f"*SURFACE, NAME={body.name.upper()}FACE, TYPE=ELEMENT")
        face_of = {(cell[i], cell[(i + 1) % corners]): f"{element}, S{i + 1}" for element, cell in zip(body.elements, body.cells)
                   for i in range(corners)}
        lines += [face_of[tuple(facet[:2])] for facet in body.facets["x1"]]
    for body, nodes in zip(bodies, feet):
        lines += [f"*NSET, NSET={body.name.upper()}FEET"] + [f"{n}," for n in nodes]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"{YOUNG}, {POISSON}"]
    lines += [f"*SOLID SECTION, ELSET={body.name.upper()}, MATERIAL=M\n1.0" for body in bodies]
    lines += ["*SURFACE INTERACTION, NAME=DRY", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{STIFFNESS:g}"]
    if options.friction:
        lines += ["*FRICTION", f"{options.friction}, {STIFFNESS:g}"]
    lines += ["*CONTACT PAIR, INTERACTION=DRY, TYPE=SURFACE TO SURFACE", "UPPERFACE, LOWERFACE",
              "*STEP, NLGEOM, INC=2000", "*STATIC", f"{1 / options.steps}, 1.0, 1e-5, {1 / options.steps}", "*BOUNDARY", "LOWERFEET, 1, 2",
              f"UPPERFEET, 1, 1, {options.travel}", "UPPERFEET, 2, 2", "*NODE PRINT, NSET=LOWERFEET, TOTALS=ONLY", "RF", "*END STEP"]
    return "\n".join(lines) + "\n"


def main():
    options = parse()
    model, shape = Model(2), f"2D{4 * options.order}N"
    # So far left that the circles clear each other by a hundredth of the radius.
    start = -((2.01 * OUTER) ** 2 - (2 * OUTER - options.overlap) ** 2) ** 0.5
    centres = ((0.0, -OUTER), (start, OUTER - options.overlap))
    bodies = [half_ring(model, name, [options.cells, options.cells * along], centre, side, shape)
              for name, along, centre, side in zip(("Lower", "Upper"), ALONG, centres, (1, -1))]
    feet = [body.side_nodes["y0"] + body.side_nodes["y1"] for body in bodies]
    model.fix(feet[0], x=0.0, y=0.0)
    model.fix(feet[1], x=f"{options.travel!r}*t", y=0.0)
    model.interface((bodies[1], "x1"), (bodies[0], "x1"))
    for body in bodies:
        model.material(body, "strain", YOUNG, POISSON, FRICTION_COEFFICIENT=options.friction)
    model.mesh.part("LowerFeet", feet[0])
    family = "ALM frictional" if options.friction else "ALM"
    solver = {"linear_solver_settings": {"solver_type": options.solver}} if options.solver else {}
    solver |= {"residual_relative_tolerance": 1e-4, "max_iteration": 30}
    deck = model.deck(family, options.steps, friction=options.friction or None, solver=solver,
                      outputs=[json_output("reaction.json", ["REACTION"], "LowerFeet")])
    os.makedirs(options.folder, exist_ok=True)
    for name, content in (("ProjectParameters", deck), ("StructuralMaterials", {"properties": model.materials})):
        with open(os.path.join(options.folder, name + ".json"), "w") as file:
            json.dump(content, file, indent=1)
    for name, text in (("mesh.mdpa", model.finished_mesh().text()), ("arches.inp", calculix(model, bodies, feet, options))):
        with open(os.path.join(options.folder, name), "w") as file:
            file.write(text)
    print(options.folder)


if __name__ == "__main__":
    main()
