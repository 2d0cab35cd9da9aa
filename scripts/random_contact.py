#!/usr/bin/env python3
"""Runs random convex contact decks, each of which has a solution, and lists those that fail or take long.

    scripts/random_contact.py target/release/zelus --first 0 --count 300 [--keep FOLDER]

A linear elastic block stands on a table, or above it, without friction; a pressure presses it down. Only contact restrains its vertical
motion and its rotation. Shapes and orders of the cells, sizes, units, materials, the profiles of both surfaces, the gap, the loaded part,
the support sideways, the sides, the steps and the formulation are random; a seed always gives the same deck. The load lies within the width
of the block and the table is wider, so that the problem has a solution.
"""

import argparse
import json
import math
import pathlib
import random
import subprocess
import tempfile

SHAPES = {"2D3N": 1, "2D4N": 1, "2D6N": 2, "2D8N": 2, "2D9N": 2}
FORMULATIONS = [("ALMContactFrictionless", "alm_contact_process", "Frictionless")] * 3 + [
    ("ALMContactFrictionlessComponents", "alm_contact_process", "FrictionlessComponents"),
    ("PenaltyContactFrictionless", "penalty_contact_process", "Frictionless")]
# Iterations of a step that are reported as many.
MANY = 25


class Block:
    """A mapped grid of cells: nodes, cells, and the facets of its lower and upper sides."""

    def __init__(self, shape, divisions, first, place):
        self.shape, self.order = shape, SHAPES[shape]
        self.numbers, self.nodes, self.first, self.place = {}, [], first, place
        self.sizes = [self.order * n for n in divisions]
        columns, rows = divisions
        self.cells = [cell for i in range(columns) for j in range(rows) for cell in self.cells_of(self.order * i, self.order * j)]
        self.lower = [self.facet(self.order * i, self.order * (i + 1), 0) for i in range(columns)]
        self.upper = [self.facet(self.order * (i + 1), self.order * i, self.sizes[1]) for i in range(columns)]

    def node(self, i, j):
        if (i, j) not in self.numbers:
            self.numbers[i, j] = self.first + len(self.nodes)
            self.nodes.append(self.place(i / self.sizes[0], j / self.sizes[1]))
        return self.numbers[i, j]

    def facet(self, begin, end, row):
        middle = [self.node((begin + end) // 2, row)] if self.order == 2 else []
        return [self.node(begin, row), self.node(end, row), *middle]

    def cells_of(self, i, j):
        m = self.order
        corners = [(i, j), (i + m, j), (i + m, j + m), (i, j + m)]
        sides = [(i + 1, j), (i + 2, j + 1), (i + 1, j + 2), (i, j + 1)]
        lists = {
            "2D3N": [corners[:3], [corners[0], corners[2], corners[3]]],
            "2D4N": [corners],
            "2D6N": [corners[:3] + [sides[0], sides[1], (i + 1, j + 1)],
                     [corners[0], corners[2], corners[3], (i + 1, j + 1), sides[2], sides[3]]],
            "2D8N": [corners + sides],
            "2D9N": [corners + sides + [(i + 1, j + 1)]],
        }
        return [[self.node(*at) for at in cell] for cell in lists[self.shape]]

    def column(self, i):
        return [number for (at, _), number in self.numbers.items() if at == i]

    def row(self, j):
        return [number for (_, at), number in self.numbers.items() if at == j]


def profile(dice, width):
    """Height of the lower side of the block over x, from its lowest point."""
    height, waves, phase = 10 ** dice.uniform(-3, -1.2), dice.randint(1, 4), dice.uniform(0, 2 * math.pi)
    curve = dice.choice([
        lambda x: 0.0,
        lambda x: 16 * height * (x / width) ** 2,
        lambda x: height * (1 - math.cos(2 * math.pi * waves * x / width + phase)),
        lambda x: 2 * height * x / width,
        lambda x: -height * math.cos(2 * math.pi * x / width)])
    lowest = min(curve(width * (at / 400 - 0.5)) for at in range(401))
    return lambda x: curve(x) - lowest


def draw(seed, folder):
    """Writes the deck of a seed."""
    dice = random.Random(seed)
    unit, force = 10 ** dice.uniform(-3, 3), 10 ** dice.uniform(-2, 9)
    width, height, gap = dice.uniform(0.5, 2), dice.uniform(0.2, 1.5), dice.choice([0, 0, 1e-6, 1e-3, 0.01, 0.05])
    length, depth, hills, hill = width * dice.uniform(1.05, 2), dice.uniform(0.3, 1.5), dice.randint(1, 5), dice.choice([0, 0, 0.02])
    under, above = profile(dice, width), lambda x: hill * (math.cos(2 * math.pi * hills * x / length) - 1)

    def divisions(size):
        columns = dice.randint(4, 24)
        return [columns, max(1, round(columns * size[1] / size[0] * dice.uniform(0.4, 1.2)))]

    def place_upper(s, t):
        x = width * (s - 0.5)
        return [unit * x, unit * ((1 - t) * (under(x) + gap) + t * (height + gap))]

    def place_lower(s, t):
        x = length * (s - 0.5)
        return [unit * x, unit * (t * above(x) - depth * (1 - t))]

    shape = dice.choice(list(SHAPES))
    upper = Block(shape, divisions([width, height]), 1, place_upper)
    lower = Block(dice.choice([shape, dice.choice(list(SHAPES))]), divisions([length, depth]), 1 + len(upper.nodes), place_lower)
    nodes = upper.nodes + lower.nodes
    middle = lambda facet: (nodes[facet[0] - 1][0] + nodes[facet[1] - 1][0]) / (2 * unit)
    from_, to = dice.choice([(-0.5, 0.5), (-0.25, 0.25), (0.0, 0.45)])
    loaded = [facet for facet in upper.upper if from_ * width < middle(facet) < to * width]
    top = upper.row(upper.sizes[1])
    guide = dice.choice([[min(top, key=lambda n: abs(nodes[n - 1][0]))], top, upper.column(0)])
    young = [force * 10 ** dice.uniform(0, 3) for _ in range(2)]
    pressure = min(young) * 10 ** dice.uniform(-5, -2.3)
    write_mesh(folder, nodes, upper, lower, loaded, guide)
    law = dice.choice(["LinearElasticPlaneStrain2DLaw", "LinearElasticPlaneStress2DLaw"])
    material = lambda name, number: {
        "model_part_name": f"Structure.{name}", "properties_id": number, "Material": {"constitutive_law": {"name": law}, "Tables": {},
        "Variables": {"YOUNG_MODULUS": young[number - 1], "POISSON_RATIO": dice.choice([0.0, 0.2, 0.3, 0.4])}}}
    materials = {"properties": [material("Upper", 1), material("Lower", 2)]}
    (folder / "StructuralMaterials.json").write_text(json.dumps(materials))
    deck = deck_of(dice.choice(FORMULATIONS), dice.choice(["Foot", "Table"]), dice.choice([1, 1, 2, 5]), pressure)
    (folder / "ProjectParameters.json").write_text(json.dumps(deck, indent=1))


def write_mesh(folder, nodes, upper, lower, loaded, guide):
    lines = ["Begin Properties 0", "End Properties", "Begin Nodes"]
    lines += [f"{number} {x!r} {y!r} 0.0" for number, (x, y) in enumerate(nodes, 1)] + ["End Nodes"]
    parts, elements, conditions = {}, 0, 0
    for name, block in (("Upper", upper), ("Lower", lower)):
        lines.append(f"Begin Elements SmallDisplacementElement{block.shape}")
        begin = elements + 1
        for elements, cell in enumerate(block.cells, begin):
            lines.append(f"{elements} 0 {' '.join(map(str, cell))}")
        lines.append("End Elements")
        own = range(block.first, block.first + len(block.nodes))
        parts[name] = {"Nodes": own, "Elements": range(begin, elements + 1)}
    for name, kind, facets in (("Load", "LineLoadCondition", loaded), ("Foot", "LineCondition", upper.lower),
                               ("Table", "LineCondition", lower.upper)):
        lines.append(f"Begin Conditions {kind}2D{len(facets[0])}N")
        begin = conditions + 1
        for conditions, facet in enumerate(facets, begin):
            lines.append(f"{conditions} 0 {' '.join(map(str, facet))}")
        lines.append("End Conditions")
        parts[name] = {"Nodes": sorted({node for facet in facets for node in facet}), "Conditions": range(begin, conditions + 1)}
    parts["Contact"] = {kind: [*parts["Foot"][kind], *parts["Table"][kind]] for kind in ("Nodes", "Conditions")}
    parts["Base"], parts["Guide"] = {"Nodes": lower.row(0)}, {"Nodes": guide}
    for name, lists in parts.items():
        lines.append(f"Begin SubModelPart {name}")
        for kind, numbers in lists.items():
            lines += [f"Begin SubModelPart{kind}", *map(str, sorted(numbers)), f"End SubModelPart{kind}"]
        lines.append("End SubModelPart")
    (folder / "mesh.mdpa").write_text("\n".join(lines) + "\n")


def deck_of(formulation, slave, steps, pressure):
    mortar, process, kind = formulation
    support = lambda part, held: {
        "python_module": "assign_vector_variable_process", "kratos_module": "KratosMultiphysics", "Parameters": {
            "model_part_name": f"Structure.{part}", "variable_name": "DISPLACEMENT", "constrained": held,
            "value": [0.0 if own else None for own in held], "interval": [0.0, "End"]}}
    load = {"python_module": "assign_vector_by_direction_to_condition_process", "kratos_module": "KratosMultiphysics", "Parameters": {
        "model_part_name": "Structure.Load", "variable_name": "LINE_LOAD", "modulus": f"({pressure!r})*t", "direction": [0.0, -1.0, 0.0],
        "interval": [0.0, "End"]}}
    contact = {"python_module": process, "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication", "Parameters": {
        "model_part_name": "Structure", "contact_type": kind, "contact_model_part": {"0": ["Contact"]},
        "assume_master_slave": {"0": [slave]}}}
    return {
        "problem_data": {"problem_name": "random", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0, "end_time": 1.0},
        "solver_settings": {
            "solver_type": "Static", "model_part_name": "Structure", "domain_size": 2,
            "model_import_settings": {"input_type": "mdpa", "input_filename": "mesh"},
            "material_import_settings": {"materials_filename": "StructuralMaterials.json"},
            "time_stepping": {"time_step": 1.0 / steps}, "convergence_criterion": "contact_residual_criterion",
            "contact_settings": {"mortar_type": mortar}},
        "processes": {
            "constraints_process_list": [support("Base", [True, True, False]), support("Guide", [True, False, False])],
            "loads_process_list": [load], "contact_process_list": [contact]}}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seconds", type=float, default=60.0, help="seconds after which a run counts as failed")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the decks; a scratch folder when not given")
    options = parser.parse_args()
    program = options.program.resolve()
    failed, repeated, long, iterations = [], 0, 0, 0
    with tempfile.TemporaryDirectory() as scratch:
        for seed in range(options.first, options.first + options.count):
            folder = (options.keep or pathlib.Path(scratch)) / str(seed)
            folder.mkdir(parents=True, exist_ok=True)
            draw(seed, folder)
            command = [program, "run", "ProjectParameters.json", "--threads", "1", "--report", "report.json"]
            try:
                run = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=options.seconds)
                code, report = run.returncode, json.loads((folder / "report.json").read_text())
            except (subprocess.TimeoutExpired, FileNotFoundError):
                code, report = "no end", {"steps": []}
            taken = [len(step["iterations"]) if isinstance(step["iterations"], list) else step["iterations"] for step in report["steps"]]
            iterations += sum(taken)
            repeated += any(not step["converged"] for step in report["steps"])
            long += max(taken, default=0) > MANY
            if code != 0:
                failed.append(seed)
                print(f"{seed}: exit code {code}, iterations {taken}", flush=True)
    print(f"{options.count - len(failed)} of {options.count} decks end with a result; {repeated} repeat or cut a step, "
          f"{long} take more than {MANY} iterations for one; {iterations} iterations in all")


if __name__ == "__main__":
    main()
