#!/usr/bin/env python3
"""Write a contact deck of any size: an upper block pressed on a lower one, hexahedra, meshes not matching.

    gen_blocks.py OUT --lower 24 --upper 18 [--kind frictionless] [--steps 1] [--solver amgcl]

The lower block is the unit cube in --lower³ cells, held at its bottom; the upper one 0.8 × 0.8 × 0.8 in --upper³
cells, guided on two sides and pressed from above with 1 MPa in equal steps; its lower face carries the multipliers.
Kinds: what holds the blocks apart or together, `finite` neo-Hookean bodies with finite strain, and `body`, the lower
block alone under the load, linear, which CalculiX is given too (blocks.inp). `heat` is the lower block alone, heated from
above and cooled from below, at rest; `thermal` the frictionless blocks with heat that passes from one to the other by their
pressure, which makes them grow, with staggered coupling in each step.
"""
import argparse
import json
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "tests", "cases"))
from deck import CONTACT, condition_load, fix, material, process, solver  # noqa: E402
from mesh import Box, Mesh  # noqa: E402

PRESSURE = 1e6
SHEAR = 2e5
FRICTION = 0.3
STIFFNESSES = (2.1e9, 1.0e9)
POISSON = 0.3
# kind -> mortar type, module of its process, contact type
KINDS = {
    "frictionless": ("ALMContactFrictionless", "alm_contact_process", "Frictionless"),
    "components": ("ALMContactFrictionlessComponents", "alm_contact_process", "FrictionlessComponents"),
    "friction": ("ALMContactFrictional", "alm_contact_process", "Frictional"),
    "penalty": ("PenaltyContactFrictionless", "penalty_contact_process", "Frictionless"),
    "tying": ("ComponentsMeshTying", "mesh_tying_process", None),
    "finite": ("ALMContactFrictionless", "alm_contact_process", "Frictionless"),
    "body": (None, None, None),
    "thermal": ("ALMContactFrictionless", "alm_contact_process", "Frictionless"),
    "heat": (None, None, None),
}
CONDUCTIVITY = 10.0


def calculix(path, mesh, box):
    """The single body for CalculiX: one linear step with its own iterative solver, no output but displacements."""
    area = 1.0 / len(box.facets["z1"])
    forces = {}
    for facet in box.facets["z1"]:
        for node in facet:
            forces[node] = forces.get(node, 0.0) - PRESSURE * area / len(facet)
    with open(path, "w") as file:
        file.write("*NODE, NSET=ALL\n" + "".join(f"{n}, {x!r}, {y!r}, {z!r}\n" for n, (x, y, z) in mesh.nodes.items()))
        file.write("*ELEMENT, TYPE=C3D8, ELSET=BODY\n")
        file.write("".join(f"{i}, {', '.join(map(str, c))}\n" for i, (_, c) in enumerate(mesh.elements, 1)))
        file.write("*NSET, NSET=FIXED\n" + "".join(f"{n},\n" for n in box.side_nodes["z0"]))
        file.write(f"*MATERIAL, NAME=M\n*ELASTIC\n{STIFFNESSES[0]!r}, {POISSON!r}\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n")
        file.write("*STEP\n*STATIC, SOLVER=ITERATIVE CHOLESKY\n*BOUNDARY\nFIXED, 1, 3\n*CLOAD\n")
        file.write("".join(f"{n}, 3, {force!r}\n" for n, force in sorted(forces.items())))
        file.write("*NODE PRINT, NSET=FIXED, TOTALS=ONLY\nRF\n*END STEP\n")


def write(out, lower, upper, kind="frictionless", steps=1, solver_type=""):
    """Writes the deck into the folder `out`; the numbers of unknowns without multipliers and of elements."""
    mortar, module, contact_type = KINDS[kind]
    element = {"finite": "TotalLagrangianElement", "heat": "Element"}.get(kind, "SmallDisplacementElement")
    mesh = Mesh()
    below = Box(mesh, "Lower", "3D8N", [lower] * 3, (0.0, 0.0, 0.0), (1.0, 1.0, 1.0), element=element)
    mesh.part("Fixed", below.side_nodes["z0"])
    constraints, contact = [fix("Fixed", 0.0, 0.0, 0.0)], []
    materials = [material("Lower", 1, "3d", STIFFNESSES[0], POISSON, DENSITY=1000.0)]
    if kind in ("body", "heat"):
        mesh.part("Load", below.side_nodes["z1"], (), below.conditions("z1", "SurfaceLoad" if kind == "body" else "Surface"))
    else:
        above = Box(mesh, "Upper", "3D8N", [upper] * 3, (0.1, 0.1, 1.0), (0.9, 0.9, 1.8), element=element)
        master, slave = below.conditions("z1", "Surface"), above.conditions("z0", "Surface")
        mesh.part("GuideX", above.side_nodes["x0"])
        mesh.part("GuideY", above.side_nodes["y0"])
        mesh.part("Load", above.side_nodes["z1"], (), above.conditions("z1", "SurfaceLoad"))
        mesh.part("ContactUpper", above.side_nodes["z0"], (), slave)
        mesh.part("Contact_Part", below.side_nodes["z1"] + above.side_nodes["z0"], (), master + slave)
        materials.append(material("Upper", 2, "3d", STIFFNESSES[1], POISSON, DENSITY=1000.0))
        constraints.append(fix("GuideY", None, 0.0))
        if kind != "friction":
            constraints.append(fix("GuideX", 0.0))
        parts = "mesh_tying_model_part" if kind == "tying" else "contact_model_part"
        asked = {"model_part_name": "Structure", "assume_master_slave": {"0": ["ContactUpper"]},
                 parts: {"0": ["Contact_Part"]}}
        if contact_type:
            asked["contact_type"] = contact_type
        if kind == "friction":
            asked["friction_coefficients"] = {"0": FRICTION}
            for entry in materials:
                entry["Material"]["Variables"]["FRICTION_COEFFICIENT"] = FRICTION
        contact = [process(module, asked, CONTACT)]
    if kind == "finite":
        for entry in materials:
            entry["Material"]["constitutive_law"]["name"] = "HyperElastic3DLaw"
    along = SHEAR if kind == "friction" else 0.0
    size = (PRESSURE ** 2 + along ** 2) ** 0.5
    settings = solver(3, "blocks", 1.0 / steps)
    # Whole steps, of the same number in Kratos, whatever round-off makes of their sum.
    settings["time_stepping"]["last_step"] = "whole"
    settings.update({"residual_relative_tolerance": 1e-6, "residual_absolute_tolerance": 1e-9, "max_iteration": 25})
    if mortar:
        settings["contact_settings"] = {"mortar_type": mortar}
        settings["convergence_criterion"] = "contact_residual_criterion"
    if solver_type:
        settings["linear_solver_settings"] = {"solver_type": solver_type}
    deck = {
        "problem_data": {"problem_name": "blocks", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0,
                         "end_time": 1.0 - 0.5 / steps},
        "solver_settings": settings,
        "processes": {
            "constraints_process_list": constraints,
            "loads_process_list": [condition_load("Load", "SURFACE_LOAD", f"{size!r}*t", (along / size, 0.0, -PRESSURE / size))],
            "contact_process_list": contact,
        },
    }
    files = {"ProjectParameters.json": deck, "StructuralMaterials.json": {"properties": materials}}
    if kind in ("heat", "thermal"):
        files["ThermalMaterials.json"] = add_heat(deck, kind, ["Lower"] if kind == "heat" else ["Lower", "Upper"], solver_type)
    if kind == "thermal":
        for entry in materials:
            entry["Material"]["constitutive_law"]["name"] = "ThermalElasticIsotropic3D"
            entry["Material"]["Variables"].update({"THERMAL_EXPANSION_COEFFICIENT": 1e-6, "REFERENCE_TEMPERATURE": 0.0})
    os.makedirs(out, exist_ok=True)
    for name, content in files.items():
        with open(os.path.join(out, name), "w") as file:
            json.dump(content, file, indent=1)
    with open(os.path.join(out, "blocks.mdpa"), "w") as file:
        file.write(mesh.text())
    if kind == "body":
        calculix(os.path.join(out, "blocks.inp"), mesh, below)
    return {"heat": 1, "thermal": 4}.get(kind, 3) * len(mesh.nodes), len(mesh.elements)


def add_heat(deck, kind, bodies, solver_type):
    """Heat alone, or beside the structure of the deck; the materials of heat."""
    heat = {
        "solver_type": "stationary", "model_part_name": "Structure", "domain_size": 3, "echo_level": 0,
        "model_import_settings": {"input_type": "mdpa", "input_filename": "blocks"},
        "material_import_settings": {"materials_filename": "ThermalMaterials.json"},
        "time_stepping": deck["solver_settings"]["time_stepping"],
        "element_replace_settings": {"element_name": "LaplacianElement", "condition_name": "ThermalFace"},
    }
    if solver_type:
        heat["linear_solver_settings"] = {"solver_type": solver_type}

    def held(part, value):
        return process("assign_scalar_variable_process", {
            "model_part_name": f"Structure.{part}", "variable_name": "TEMPERATURE", "constrained": True, "value": value,
            "interval": [0.0, "End"]})

    if kind == "heat":
        deck["analysis_stage"] = "KratosMultiphysics.ConvectionDiffusionApplication.convection_diffusion_analysis"
        deck["solver_settings"] = heat
        warm = process("assign_scalar_variable_process", {
            "model_part_name": "Structure.Load", "variable_name": "FACE_HEAT_FLUX", "constrained": False,
            "value": "1000.0*(1.0+x*y)", "interval": [0.0, "End"]})
        deck["processes"] = {"temperatures": [held("Fixed", 0.0), warm]}
    else:
        heat["model_import_settings"] = {"input_type": "use_input_model_part"}
        heat["element_replace_settings"] = {"element_name": "LaplacianElement"}
        deck["solver_settings"] = {"solver_type": "ThermoMechanicallyCoupled", "domain_size": 3,
                                   "structural_solver_settings": deck["solver_settings"], "thermal_solver_settings": heat}
        deck["processes"]["temperatures"] = [held("Fixed", 0.0), held("Load", 100.0), process("thermal_contact_process", {
            "model_part_name": "Structure", "contact_model_part": {"0": ["Contact_Part"]},
            "assume_master_slave": {"0": ["ContactUpper"]},
            "conductance": [{"law": "pressure", "conductance": 100.0, "hardness": 1e6}]})]
    return {"properties": [
        {"model_part_name": f"Structure.{body}", "properties_id": number, "Material": {"Tables": {}, "Variables": {
            "CONDUCTIVITY": CONDUCTIVITY, "DENSITY": 1000.0, "SPECIFIC_HEAT": 1.0}}}
        for number, body in enumerate(bodies, 1)]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", metavar="OUT", help="folder of the deck")
    parser.add_argument("--lower", type=int, default=8, help="cells along an edge of the lower block")
    parser.add_argument("--upper", type=int, default=6, help="cells along an edge of the upper block")
    parser.add_argument("--kind", choices=KINDS, default="frictionless")
    parser.add_argument("--steps", type=int, default=1)
    parser.add_argument("--solver", default="", help="linear solver the deck names; none by default")
    options = parser.parse_args()
    unknowns, elements = write(options.out, options.lower, options.upper, options.kind, options.steps, options.solver)
    print(f"{options.out}: {unknowns} unknowns without multipliers, {elements} elements")


if __name__ == "__main__":
    main()
