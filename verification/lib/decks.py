"""Decks of the examples, run on a scratch copy."""
import json, os, shutil, subprocess, tempfile

from . import ROOT, solution


class Report:
    """Numbers of a run for an outcome."""

    def __init__(self, report):
        self.steps, self.warnings, self.model = report["steps"], [], None
        self.iterations = sum(len(s["iterations"]) for s in self.steps)
        self.cuts = sum(not s["converged"] for s in self.steps)


def run_deck(name, change=None, results=None):
    """Runs `examples`/name; `change` may alter the deck. Returns the report, and the JSON file `results` it wrote."""
    folder, file_name = os.path.split(os.path.join(ROOT, "examples", name))
    with tempfile.TemporaryDirectory() as scratch:
        copy = shutil.copytree(folder, os.path.join(scratch, "deck"))
        with open(os.path.join(copy, file_name)) as file:
            deck = json.load(file)
        if change:
            change(deck)
            with open(os.path.join(copy, file_name), "w") as file:
                json.dump(deck, file)
        done = subprocess.run([solution.PROGRAM, "run", file_name, "--report", "report.json"], cwd=copy, capture_output=True, text=True)
        if done.returncode != 0:
            raise solution.Failed(f"exit {done.returncode}: {solution.message(done)}")
        with open(os.path.join(copy, "report.json")) as file:
            report = Report(json.load(file))
        if results is None:
            return report, None
        with open(os.path.join(copy, results)) as file:
            return report, json.load(file)
