#!/usr/bin/env python3
"""Time a constitutive law in Python beside that of the program.

    law_in_python.py [--cells 20] [--threads 1]

The block `body` of gen_blocks.py, with `--cells`³ hexahedra, is pressed in one step: by the law of the program, by a function of NumPy arrays
with its tangent, and by one whose tangent is found by differences. Prints processor seconds of the whole run. Needs the package zelus.
"""
import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import gen_blocks
import zelus


def matrix(points):
    young, poisson = points.parameters
    shear, first = young / 2 / (1 + poisson), young * poisson / (1 + poisson) / (1 - 2 * poisson)
    out = np.diag([2 * shear] * 3 + [shear] * 3)
    out[:3, :3] += first
    return out


@zelus.law("with_tangent")
def with_tangent(points):
    return points.strain @ matrix(points), np.broadcast_to(matrix(points), (len(points.strain), 6, 6))


@zelus.law("by_differences")
def by_differences(points):
    return points.strain @ matrix(points)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, default=20)
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as made:
        size = ["--lower", str(options.cells), "--upper", "1"]
        subprocess.run([sys.executable, gen_blocks.__file__, made, *size, "--kind", "body"], check=True, stdout=subprocess.DEVNULL)
        deck = Path(made, "ProjectParameters.json")
        solver = json.loads(deck.read_text())["solver_settings"]
        path = Path(made, solver["material_import_settings"]["materials_filename"])
        materials = json.loads(path.read_text())
        material = materials["properties"][0]["Material"]
        constants = [material["Variables"][name] for name in ("YOUNG_MODULUS", "POISSON_RATIO")]
        for function in (None, "with_tangent", "by_differences"):
            if function:
                material["constitutive_law"] = {"name": "FunctionLaw3D"}
                material["Variables"] = {"LAW_FUNCTION": function, "LAW_PARAMETERS": constants}
                path.write_text(json.dumps(materials))
            begin = time.process_time()
            result = zelus.run(deck, threads=options.threads, set={"solver_settings.analysis_type": "non_linear"})
            seconds = time.process_time() - begin
            moved = np.abs(result["DISPLACEMENT"]).max()
            print(f"{function or 'law of the program'}: {seconds:.2f} s, {result.iterations.sum()} iterations, moves by {moved:.6e}")


if __name__ == "__main__":
    main()
