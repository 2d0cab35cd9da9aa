#!/usr/bin/env python3
"""Compares input files of Abaqus and CalculiX: each runs in ccx and, by `zelus new` and `zelus run`, in zelus.

    scripts/compare_with_ccx.py target/release/zelus FILE.inp...

Prints for each file the largest displacement of the last step in both programs, the largest difference at a node relative to it, and the
warnings of `zelus new`. Where the file has elements of reduced integration, a second row is that of ccx with full integration. Files must
be whole (no *INCLUDE) and number their nodes uniquely. Displacements along axes of *TRANSFORM are compared by their size.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

OUTPUT = """    "compared": [{"python_module": "json_output_process", "kratos_module": "KratosMultiphysics", "Parameters": {
      "model_part_name": "Structure", "output_file_name": "nodes.json", "output_variables": ["DISPLACEMENT"], "time_frequency": 0.0}}],
"""


REDUCED = r"(^\*ELEMENT.*TYPE *= *(?:C3D8|C3D20|C..4|C..8))R"


def nodes_of(text):
    """Labels of the nodes of a file."""
    labels, inside = [], False
    for line in text.splitlines():
        if line.startswith("*"):
            inside = bool(re.match(r"\*NODE\s*(,|$)", line, re.I)) if not line.startswith("**") else inside
        elif inside and line.strip():
            labels.append(int(line.split(",")[0]))
    return labels


def by_ccx(text, folder):
    """Displacements of the last step by node, or the reason why there are none."""
    rows = [",".join(map(str, chunk)) for chunk in chunks(nodes_of(text), 8)]
    nset = "*NSET,NSET=COMPARED\n" + "\n".join(rows) + "\n"
    text = re.sub(r"^\*STEP", nset + "*STEP", text, count=1, flags=re.I | re.M)
    text = re.sub(r"^\*END STEP", "*NODE PRINT,NSET=COMPARED\nU\n*END STEP", text, flags=re.I | re.M)
    (folder / "job.inp").write_text(text)
    (folder / "job.dat").unlink(missing_ok=True)
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    run = subprocess.run(["ccx", "job"], cwd=folder, env=environment, capture_output=True, text=True, timeout=300)
    found = {}
    data = folder / "job.dat"
    for block in re.split(r"\n(?= displacements)", data.read_text() if data.is_file() else "")[1:]:
        if "COMPARED" not in block.splitlines()[0]:
            continue
        found = {}
        for line in block.splitlines()[1:]:
            words = line.replace(" L", "").split()
            if len(words) == 4 and words[0].isdigit():
                found[int(words[0])] = [float(word) for word in words[1:]]
            elif words:
                break
    if not found:
        return None, (re.findall(r"\*ERROR[^\n]*", run.stdout) or ["no displacements"])[0]
    return found, ""


def chunks(items, size):
    return [items[at : at + size] for at in range(0, len(items), size)]


def by_zelus(program, path, folder):
    """Displacements of the last step by node, the warnings of `new`, and the reason where it fails."""
    new = subprocess.run([program, "new", "--from", path, "-o", "deck"], cwd=folder, capture_output=True, text=True)
    said = re.findall(r"(?:warning|error)\[[^\n]*", new.stdout + new.stderr)
    if new.returncode:
        return None, said, f"new: exit {new.returncode}"
    deck = folder / "deck" / "ProjectParameters.json"
    deck.write_text(deck.read_text().replace('"output_processes": {\n', '"output_processes": {\n' + OUTPUT))
    run = subprocess.run([program, "run", "deck/ProjectParameters.json"], cwd=folder, capture_output=True, text=True, timeout=600)
    if run.returncode:
        reason = re.findall(r"(?:error)\[[^\n]*", run.stdout + run.stderr) or [(run.stderr or run.stdout)[-300:]]
        return None, said, f"run: exit {run.returncode}: {reason[0]}"
    results = json.loads(next(folder.rglob("nodes.json")).read_text())
    found = {}
    mesh = next((folder / "deck").glob("*.mdpa")).read_text().split("Begin Nodes")[1].split("End Nodes")[0]
    own = {int(line.split()[0]) for line in mesh.splitlines() if line.strip()}
    for name, values in results.items():
        # couplings and bolts add nodes
        if name.startswith("NODE_") and int(name[5:]) in own:
            parts = [values.get(f"DISPLACEMENT_{axis}", [0.0])[-1] for axis in "XYZ"]
            found[int(name[5:])] = parts
    return found, said, ""


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    for name in sys.argv[2:]:
        path = pathlib.Path(name).resolve()
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            try:
                ours, said, reason = by_zelus(program, path, folder)
                text = path.read_text(errors="replace")
                theirs, other = by_ccx(text, folder)
                full = re.sub(REDUCED, r"\1", text, flags=re.I | re.M)
                if ours and full != text:
                    integrated, _ = by_ccx(full, folder)
                    if integrated:
                        report(f"{path.name}, full integration", ours, integrated)
            except subprocess.TimeoutExpired as error:
                ours, said, reason, theirs, other = None, [], f"not finished: {error.cmd[0]}", None, ""
        if ours and theirs:
            report(path.name, ours, theirs)
        else:
            print(f"{path.name}: zelus {reason or 'ran'}; ccx {other or 'ran'}")
        for line in said:
            print(f"    {line}")


def report(name, ours, theirs):
    size = lambda u: sum(x * x for x in u) ** 0.5
    shared = [node for node in ours if node in theirs]
    largest = [max(size(all_[node]) for node in shared) for all_ in (ours, theirs)]
    apart = max(abs(size(ours[node]) - size(theirs[node])) for node in shared)
    print(f"{name}: zelus {largest[0]:.6g}, ccx {largest[1]:.6g}, apart {apart / (largest[1] or 1):.2e}", flush=True)


main()
