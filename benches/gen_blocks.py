#!/usr/bin/env python3
"""Write a contact deck of any size: an upper block pressed on a lower one, hexahedra, meshes not matching.

    gen_blocks.py OUT --lower 24 --upper 18 [--steps 1] [--solver amgcl]

The lower block is the unit cube in --lower³ cells, held at its bottom; the upper one 0.8 × 0.8 × 0.8 in --upper³
cells, guided on two sides and pressed from above with 1 MPa in equal steps; its lower face carries the multipliers.
"""
import argparse
import json
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "tests", "cases"))
from deck import CONTACT, condition_load, fix, material, process, solver  # noqa: E402
from mesh import Box, Mesh  # noqa: E402

PRESSURE = 1e6


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", metavar="OUT", help="folder of the deck")
    parser.add_argument("--lower", type=int, default=8, help="cells along an edge of the lower block")
    parser.add_argument("--upper", type=int, default=6, help="cells along an edge of the upper block")
    parser.add_argument("--steps", type=int, default=1)
    parser.add_argument("--solver", default="", help="linear solver the deck names; none by default")
    options = parser.parse_args()

    mesh = Mesh()
    lower = Box(mesh, "Lower", "3D8N", [options.lower] * 3, (0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    upper = Box(mesh, "Upper", "3D8N", [options.upper] * 3, (0.1, 0.1, 1.0), (0.9, 0.9, 1.8))
    master, slave = lower.conditions("z1", "Surface"), upper.conditions("z0", "Surface")
    mesh.part("Fixed", lower.side_nodes["z0"])
    mesh.part("GuideX", upper.side_nodes["x0"])
    mesh.part("GuideY", upper.side_nodes["y0"])
    mesh.part("Load", upper.side_nodes["z1"], (), upper.conditions("z1", "SurfaceLoad"))
    mesh.part("ContactUpper", upper.side_nodes["z0"], (), slave)
    mesh.part("Contact_Part", lower.side_nodes["z1"] + upper.side_nodes["z0"], (), master + slave)

    settings = solver(3, "blocks", 1.0 / options.steps)
    settings.update({"contact_settings": {"mortar_type": "ALMContactFrictionless"},
                     "convergence_criterion": "contact_residual_criterion",
                     "residual_relative_tolerance": 1e-6, "residual_absolute_tolerance": 1e-9, "max_iteration": 25})
    if options.solver:
        settings["linear_solver_settings"] = {"solver_type": options.solver}
    contact = {"model_part_name": "Structure", "contact_type": "Frictionless",
               "assume_master_slave": {"0": ["ContactUpper"]}, "contact_model_part": {"0": ["Contact_Part"]}}
    deck = {
        "problem_data": {"problem_name": "blocks", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0,
                         "end_time": 1.0 - 0.5 / options.steps},
        "solver_settings": settings,
        "processes": {
            "constraints_process_list": [fix("Fixed", 0.0, 0.0, 0.0), fix("GuideX", 0.0), fix("GuideY", None, 0.0)],
            "loads_process_list": [condition_load("Load", "SURFACE_LOAD", f"{PRESSURE}*t", (0.0, 0.0, -1.0))],
            "contact_process_list": [process("alm_contact_process", contact, CONTACT)],
        },
    }
    materials = [material("Lower", 1, "3d", 2.1e9, 0.3), material("Upper", 2, "3d", 1.0e9, 0.3)]
    os.makedirs(options.out, exist_ok=True)
    for name, content in (("ProjectParameters.json", deck), ("StructuralMaterials.json", {"properties": materials})):
        with open(os.path.join(options.out, name), "w") as file:
            json.dump(content, file, indent=1)
    with open(os.path.join(options.out, "blocks.mdpa"), "w") as file:
        file.write(mesh.text())
    print(f"{options.out}: {len(mesh.nodes)} nodes, {3 * len(mesh.nodes)} displacements, {len(mesh.elements)} elements")


if __name__ == "__main__":
    main()
