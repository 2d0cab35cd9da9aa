"""Runs a model by the program and reads what it wrote."""
import json, math, os, shutil, subprocess, tempfile

from deck import json_output, pretty
from .model import FAMILIES

PROGRAM = None  # set by run.py
TIME_LIMIT = 900.0


class Failed(Exception):
    """A run that did not end with exit code 0; the message says how it ended."""


class Solution:
    """Results of a run, in the numbers of the case. Fields are dictionaries from node to value at the last step or at `step`."""

    def __init__(self, model, folder, report):
        self.model, self.report = model, report
        self.fields = {name: self._read(os.path.join(folder, name + ".json")) for name in ("nodal", "contact")}
        attempts = report["steps"]
        self.iterations = sum(len(s["iterations"]) for s in attempts)
        self.cuts = sum(not s["converged"] for s in attempts)
        self.warnings = [w.get("code", str(w)) if isinstance(w, dict) else str(w) for w in report.get("warnings", [])]

    def _read(self, path):
        if not os.path.exists(path):
            return {"TIME": []}
        with open(path) as file:
            return json.load(file)

    @property
    def times(self):
        return self.fields["nodal"]["TIME"]

    def step_at(self, time):
        return min(range(len(self.times)), key=lambda i: abs(self.times[i] - time))

    def scalar(self, name, nodes, step=-1):
        for field in self.fields.values():
            out = {i: field[f"NODE_{i}"][name][step] for i in nodes if name in field.get(f"NODE_{i}", {})}
            if out:
                return out
        raise KeyError(f"{name} is not among the results")

    def vector(self, name, nodes, step=-1, scale=1.0):
        """Components in the case's own axes."""
        field = next(f for f in self.fields.values() if any(name + "_X" in f.get(f"NODE_{i}", {}) for i in nodes))
        out = {}
        for i in nodes:
            at = field[f"NODE_{i}"]
            raw = [at[f"{name}_{c}"][step] / scale if f"{name}_{c}" in at else 0.0 for c in "XYZ"]
            out[i] = self.model.direct(raw, back=True)
        return out

    def u(self, nodes, step=-1):
        return self.vector("DISPLACEMENT", nodes, step, self.model.length)

    def reaction(self, nodes, step=-1):
        """Sum of the reactions at some nodes."""
        all_of = self.vector("REACTION", nodes, step, self.model.force_scale).values()
        return [sum(r[d] for r in all_of) for d in range(3)]

    def pressure(self, pair=0, step=-1):
        """Contact pressure at slave nodes, positive in compression."""
        return {i: -p / self.model.stress for i, p in
                self.scalar("AUGMENTED_NORMAL_CONTACT_PRESSURE", self.model.watched[pair], step).items()}

    def shear(self, pair=0, step=-1):
        """Tangential traction at slave nodes."""
        return self.vector("AUGMENTED_TANGENT_CONTACT_PRESSURE", self.model.watched[pair], step, self.model.stress)

    def area(self, pair=0, step=-1):
        unit = self.model.length ** (self.model.dim - 1)
        return {i: a / unit for i, a in self.scalar("NODAL_AREA", self.model.watched[pair], step).items()}

    def number(self, name, step=-1):
        """A number that a process gives to the report of an accepted step."""
        accepted = [s for s in self.report["steps"] if s["converged"]]
        return dict(accepted[step]["interactions"])[name]

    def at(self, nodes):
        return {i: self.model.mesh.nodes[i] for i in nodes}


def solve(model, family="ALM", threads=1, keep=None, variables=("DISPLACEMENT", "REACTION"), **deck):
    """Writes the deck, runs it, and returns the solution; raises Failed where the program does not end with 0."""
    folder = keep or tempfile.mkdtemp(prefix="verification-")
    os.makedirs(folder, exist_ok=True)
    try:
        outputs = [json_output("nodal.json", variables)]
        constraint = family.startswith("MPC") or family == "tie"
        if model.pairs and not constraint:
            names = ["AUGMENTED_NORMAL_CONTACT_PRESSURE", "NODAL_AREA"]
            names += ["AUGMENTED_TANGENT_CONTACT_PRESSURE"] * ("frictional" in family)
            model.mesh.part("Slaves", {i for ids in model.watched.values() for i in ids})
            outputs.append(json_output("contact.json", names, "Slaves", historical=False))
        project = model.deck(family, outputs=outputs, **deck)
        for name, text in (("ProjectParameters.json", pretty(project)), ("mesh.mdpa", model.finished_mesh().text()),
                           ("StructuralMaterials.json", pretty({"properties": model.materials}))):
            with open(os.path.join(folder, name), "w") as file:
                file.write(text)
        command = [PROGRAM, "run", "ProjectParameters.json", "--report", "report.json", "--threads", str(threads)]
        try:
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=TIME_LIMIT)
        except subprocess.TimeoutExpired:
            raise Failed(f"no end within {TIME_LIMIT:g} s") from None
        if done.returncode != 0:
            raise Failed(f"exit {done.returncode}: {message(done)}")
        with open(os.path.join(folder, "report.json")) as file:
            return Solution(model, folder, json.load(file))
    finally:
        if not keep:
            shutil.rmtree(folder, ignore_errors=True)


def message(done):
    """The first error that a finished program printed."""
    lines = [line.strip() for line in (done.stdout + done.stderr).splitlines() if "error[" in line]
    return lines[0] if lines else "no message"


def norm(v):
    return math.sqrt(sum(c * c for c in v))
