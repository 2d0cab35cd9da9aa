#!/usr/bin/env python3
"""Time a constitutive law in Python beside that of the program.

    law_in_python.py [--cells 20] [--threads 1]

A block of `--cells`³ hexahedra of small strain is pressed by its upper side, elastic, in one step: by the law of the program, by a function of
NumPy arrays with its tangent, and by one whose tangent is found by differences. Prints processor seconds of the whole run. Needs the
package zelus.
"""
import argparse
import json
import tempfile
import time
from pathlib import Path

import numpy as np

import zelus

MODULUS, RATIO = 200.0, 0.3


def block(folder, cells):
    """Writes mesh and deck; gives the path of the deck."""
    count = cells + 1
    at = lambda i, j, k: 1 + i + count * (j + count * k)
    every = [(i, j, k) for k in range(count) for j in range(count) for i in range(count)]
    nodes = [f"{at(*p)} {p[0] / cells} {p[1] / cells} {p[2] / cells}" for p in every]
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    cell = lambda i, j, k: " ".join(str(at(i + a, j + b, k + c)) for c in (0, 1) for a, b in corners)
    elements = [f"{n + 1} 0 {cell(*p)}" for n, p in enumerate(p for p in every if max(p) < cells)]
    lines = ["Begin Properties 0", "End Properties", "Begin Nodes", *nodes, "End Nodes"]
    lines += ["Begin Elements SmallDisplacementElement3D8N", *elements, "End Elements"]
    for name, height in (("Bottom", 0), ("Top", cells)):
        own = [str(at(*p)) for p in every if p[2] == height]
        lines += [f"Begin SubModelPart {name}", "Begin SubModelPartNodes", *own, "End SubModelPartNodes", "End SubModelPart"]
    (folder / "block.mdpa").write_text("\n".join(lines))
    held = lambda part, value: {
        "python_module": "assign_vector_variable_process",
        "Parameters": {"model_part_name": f"Structure.{part}", "variable_name": "DISPLACEMENT", "constrained": True, "value": value},
    }
    deck = {
        "problem_data": {"problem_name": "block", "start_time": 0.0, "end_time": 1.0, "parallel_type": "OpenMP", "echo_level": 0},
        "solver_settings": {
            "solver_type": "Static",
            "analysis_type": "non_linear",
            "model_part_name": "Structure",
            "domain_size": 3,
            "model_import_settings": {"input_type": "mdpa", "input_filename": "block"},
            "material_import_settings": {"materials_filename": "materials.json"},
            "time_stepping": {"time_step": 1.0},
        },
        "processes": {"held": [held("Bottom", [0.0, 0.0, 0.0]), held("Top", [0.0, 0.0, -0.01])]},
    }
    (folder / "deck.json").write_text(json.dumps(deck))
    return folder / "deck.json"


def write_material(folder, law, **variables):
    material = {"constitutive_law": {"name": law}, "Variables": variables}
    (folder / "materials.json").write_text(
        json.dumps({"properties": [{"model_part_name": "Structure", "properties_id": 0, "Material": material}]})
    )


def matrix():
    shear, first = MODULUS / 2 / (1 + RATIO), MODULUS * RATIO / (1 + RATIO) / (1 - 2 * RATIO)
    out = np.diag([2 * shear] * 3 + [shear] * 3)
    out[:3, :3] += first
    return out


@zelus.law("with_tangent")
def with_tangent(points):
    return points.strain @ matrix(), np.broadcast_to(matrix(), (len(points.strain), 6, 6))


@zelus.law("by_differences")
def by_differences(points):
    return points.strain @ matrix()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, default=20)
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    functions = {"function with tangent": "with_tangent", "function, tangent by differences": "by_differences"}
    materials = {"law of the program": ("LinearElastic3DLaw", {"YOUNG_MODULUS": MODULUS, "POISSON_RATIO": RATIO})}
    materials |= {name: ("FunctionLaw3D", {"LAW_FUNCTION": own}) for name, own in functions.items()}
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        deck = block(folder, options.cells)
        for name, (law, variables) in materials.items():
            write_material(folder, law, **variables)
            begin = time.process_time()
            result = zelus.run(deck, threads=options.threads)
            seconds = time.process_time() - begin
            force = result.of_part("Top", "REACTION")[:, 2].sum()
            print(f"{name}: {seconds:.2f} s, {result.iterations.sum()} iterations, force {force:.6f}")


if __name__ == "__main__":
    main()
