#!/usr/bin/env python3
"""Solve a contact deck of gen_arches.py, gen_lug.py or gen_blocks.py (kind frictionless) by GetFEM: run by compare.py.

    getfem_contact.py [FOLDER/]ProjectParameters.json

Reads mesh, materials, supports, surface loads and the contact pair of the deck. Contact is GetFEM's integral contact with large sliding
(raytracing, augmented Lagrangian), with friction where the deck has it. reaction.json gets the force of contact on the body with the slave
surface, which is what the supports of the other one bear. A step that does not converge ends the run. Needs python3-getfem.
"""
import json
import math
import os
import re
import sys

import getfem as gf
import numpy as np

# By nodes of a cell: geometric transformation and element, which nodes of the deck are GetFEM's, corners, element of multipliers, integration.
CELLS = {
    "2D4N": ("GT_QK(2,1)", "FEM_QK(2,1)", (0, 1, 3, 2), "FEM_QK(2,1)", "IM_GAUSS_PARALLELEPIPED(2,4)"),
    "2D8N": ("GT_Q2_INCOMPLETE(2)", "FEM_Q2_INCOMPLETE(2)", (0, 4, 1, 7, 5, 3, 6, 2), "FEM_QK(2,1)", "IM_GAUSS_PARALLELEPIPED(2,6)"),
    "3D8N": ("GT_QK(3,1)", "FEM_QK(3,1)", (0, 1, 3, 2, 4, 5, 7, 6), "FEM_QK(3,1)", "IM_GAUSS_PARALLELEPIPED(3,4)"),
    "3D4N": ("GT_PK(3,1)", "FEM_PK(3,1)", (0, 1, 2, 3), "FEM_PK(3,1)", "IM_TETRAHEDRON(5)"),
    "3D10N": ("GT_PK(3,2)", "FEM_PK(3,2)", (0, 4, 1, 6, 5, 2, 7, 8, 9, 3), "FEM_PK(3,1)", "IM_TETRAHEDRON(6)"),
}


def read_mdpa(path):
    """Coordinates of nodes and (name, nodes) of elements, by number, and the numbers of nodes and elements of each part, by name."""
    nodes, elements, parts, block, name, part = {}, {}, {}, [], "", {}
    with open(path) as file:
        for line in file:
            words = line.split("//")[0].split()
            if not words:
                continue
            if words[0] == "Begin":
                block.append(words[1])
                if words[1] == "SubModelPart":
                    part = parts[words[2]] = {"SubModelPartNodes": [], "SubModelPartElements": []}
                name = words[2] if len(words) > 2 else ""
            elif words[0] == "End":
                block.pop()
            elif block[-1] == "Nodes":
                nodes[int(words[0])] = [float(w) for w in words[1:4]]
            elif block[-1] == "Elements":
                elements[int(words[0])] = (name, [int(w) for w in words[2:]])
            elif block[-1] in part:
                part[block[-1]] += [int(w) for w in words]
    return nodes, elements, parts


def value_at(given, time):
    """A number, or an expression of the deck at a time."""
    return eval(given, {"__builtins__": {}}, {"t": time, "abs": abs}) if isinstance(given, str) else float(given)


class Body:
    """A body of the deck as a mesh of GetFEM, so that nodes of two bodies at one place stay apart."""

    def __init__(self, name, nodes, cells, dimension):
        shape = re.search(r"\dD\d+N$", cells[0][0]).group()
        transformation, element, order, multiplier, points = CELLS[shape]
        self.name, self.mesh, self.regions = name, gf.Mesh("empty", dimension), 0
        geometry = gf.GeoTrans(transformation)
        for _, cell in cells:
            self.mesh.add_convex(geometry, np.array([nodes[cell[i]][:dimension] for i in order]).T)
        place = lambda point: tuple(np.round(point, 8))
        points_of = {place(point): i for i, point in enumerate(self.mesh.pts().T)}
        self.points = {n: points_of[place(nodes[n][:dimension])] for _, cell in cells for n in cell}
        self.field, self.multipliers = gf.MeshFem(self.mesh, dimension), gf.MeshFem(self.mesh, dimension)
        self.field.set_fem(gf.Fem(element))
        self.multipliers.set_fem(gf.Fem(multiplier))
        self.integration = gf.MeshIm(self.mesh, gf.Integ(points))

    def region(self, nodes):
        """Number of a new region: the faces of the skin all of whose points are among the nodes."""
        points = {self.points[n] for n in nodes if n in self.points}
        faces = [face for face in self.mesh.outer_faces().T if set(self.mesh.pid_in_faces(face.reshape(2, 1))) <= points]
        self.regions += 1
        self.mesh.set_region(self.regions, np.array(faces).T)
        return self.regions


def main():
    folder, name = os.path.split(os.path.abspath(sys.argv[1]))
    with open(os.path.join(folder, name)) as file:
        deck = json.load(file)
    with open(os.path.join(folder, "StructuralMaterials.json")) as file:
        materials = json.load(file)["properties"]
    settings, processes = deck["solver_settings"], deck["processes"]
    dimension = settings["domain_size"]
    nodes, elements, parts = read_mdpa(os.path.join(folder, settings["model_import_settings"]["input_filename"] + ".mdpa"))
    part_of = lambda entry: parts[entry["model_part_name"].split(".")[-1]]
    model, bodies, held, loads = gf.Model("real"), [], [], []

    for entry in materials:
        own, cells = entry["Material"]["Variables"], [elements[e] for e in part_of(entry)["SubModelPartElements"]]
        body = Body(f"u{len(bodies)}", nodes, cells, dimension)
        young, poisson = own["YOUNG_MODULUS"], own["POISSON_RATIO"]
        lame, shear = young * poisson / (1 + poisson) / (1 - 2 * poisson), young / 2 / (1 + poisson)
        model.add_fem_variable(body.name, body.field)
        for name, value in (("lame", lame), ("shear", shear), ("both", [lame, shear])):
            model.add_initialized_data(name + body.name, value)
        if cells[0][0].startswith("TotalLagrangian"):
            model.add_finite_strain_elasticity_brick(body.integration, "SaintVenant Kirchhoff", body.name, "both" + body.name)
        else:
            model.add_isotropic_linearized_elasticity_brick(body.integration, body.name, "lame" + body.name, "shear" + body.name)
        bodies.append(body)

    def place_of(entry):
        """The body of a support or load, and a region of its nodes."""
        on = part_of(entry)["SubModelPartNodes"]
        body = next(b for b in bodies if on[0] in b.points)
        return body, body.region(on)

    for entry in (process["Parameters"] for process in processes["constraints_process_list"]):
        body, region = place_of(entry)
        fixed, name = entry["constrained"][:dimension], f"held{len(held)}"
        model.add_initialized_data(name, np.zeros(dimension))
        if all(fixed):
            model.add_Dirichlet_condition_with_simplification(body.name, region, name)
        else:
            model.add_initialized_data(name + "components", np.diag(np.array(fixed, float)).flatten(), [dimension, dimension])
            model.add_generalized_Dirichlet_condition_with_penalization(
                body.integration, body.name, 1e6 * young, region, name, name + "components")
        held.append((name, [value or 0.0 for value in entry["value"][:dimension]]))
    for entry in (process["Parameters"] for process in processes["loads_process_list"]):
        body, region = place_of(entry)
        model.add_initialized_data(f"load{len(loads)}", np.zeros(dimension))
        model.add_source_term_brick(body.integration, body.name, f"load{len(loads)}", region)
        loads.append((f"load{len(loads)}", entry["modulus"], np.array(entry["direction"][:dimension])))

    pair = processes["contact_process_list"][0]["Parameters"]
    slaves = set(parts[pair["assume_master_slave"]["0"][0]]["SubModelPartNodes"])
    masters = {n for part in pair["contact_model_part"]["0"] for n in parts[part]["SubModelPartNodes"]} - slaves
    friction = pair.get("friction_coefficients", {}).get("0", 0.0)
    slave, master = sorted(bodies, key=lambda body: not slaves <= set(body.points))
    region = slave.region(slaves)
    size = min(np.min(body.mesh.convex_radius()) for body in bodies)
    # Of the order of the stiffness of a layer of cells.
    model.add_initialized_data("augmentation", 0.1 * young / size)
    model.add_filtered_fem_variable("traction", slave.multipliers, region)
    former = {body: () for body in bodies}
    terms = []
    if friction:
        terms = ["friction", "speed"]
        model.add_initialized_data("friction", friction)
        model.add_initialized_data("speed", 1.0)
        for body in bodies:
            former[body] = ("former" + body.name,)
            model.add_initialized_fem_data("former" + body.name, body.field, np.zeros(body.field.nbdof()))
    brick = model.add_integral_large_sliding_contact_brick_raytracing("augmentation", 4 * size, *terms)
    model.add_master_contact_boundary_to_large_sliding_contact_brick(brick, master.integration, master.region(masters), master.name, *former[master])
    model.add_slave_contact_boundary_to_large_sliding_contact_brick(brick, slave.integration, region, slave.name, "traction", *former[slave])
    # The slave starts a trace inside the master: contact must hold what nothing else does.
    normal = np.mean(slave.mesh.normal_of_faces(slave.mesh.region(region)), axis=1)
    model.set_variable(slave.name, np.tile(1e-6 * size * normal, slave.field.nbdof() // dimension))

    step = settings["time_stepping"]["time_step"]
    force = {f"REACTION_{c}": [] for c in "XYZ"[:dimension]}
    for number in range(1, math.ceil((deck["problem_data"]["end_time"] - 1e-9) / step) + 1):
        for name, values in held:
            model.set_variable(name, np.array([value_at(value, number * step) for value in values]))
        for name, modulus, direction in loads:
            model.set_variable(name, value_at(modulus, number * step) * direction)
        for body in bodies if friction else ():
            model.set_variable("former" + body.name, model.variable(body.name))
        iterations, converged = model.solve("max_res", 1e-6, "max_iter", 40, "lsearch", "simplest", "alpha min", 0.4)
        if not converged:
            sys.exit(f"step {number} has not converged in {iterations} iterations")
        for at, values in enumerate(force.values(), 1):
            values.append(float(gf.asm_generic(slave.integration, 0, f"traction({at})", region, model)))
        print("step", number, "iterations", iterations, "force", *(values[-1] for values in force.values()))
    with open(os.path.join(folder, "reaction.json"), "w") as file:
        json.dump({"TIME": [], "CONTACT": force}, file)


if __name__ == "__main__":
    main()
