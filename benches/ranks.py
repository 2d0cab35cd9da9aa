#!/usr/bin/env python3
"""Time zelus on one rank and on several, phase by phase, and print a markdown table.

    ranks.py [--zelus PROGRAM] [--ranks 1 2] [--rounds 3] [--engine none] DECK...

A DECK is a ProjectParameters.json or its folder. Each number of ranks runs on a scratch copy, alternately, with one thread
a rank, none bound to a core; a phase's time is that of rank 0 on the clock, from the report of the run, and the table
gives the shortest of the rounds. "steps" is the whole work of the steps: assembly, solve, and all that is sent and
waited for. Efficiency is (ranks · time)⁻¹ relative to the first number of ranks. The last row is what processors were
busy with all ranks together; on a machine that does other work it says more than the clock, but ranks of PETSc that
wait count as busy. `--engine` is the "petsc_engine" of runs on several ranks: "none" lets rank 0 solve, "automatic"
PETSc. The program must be built with the feature mpi or petsc. A run that fails shows as such and ends in exit code 1.
"""
import argparse
import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile

from compare import ROOT, deck_of, without_checks

GROUPS = {
    "read and set up": ("read", "set up"),
    "assemble": ("assemble: elements", "assemble: interactions", "assemble: residual"),
    "solve": ("linear: order", "linear: factor", "linear: solve"),
    "steps": ("solve steps",),
    "total": ("total",),
}
BUSY = "processors, all ranks"


def with_engine(path, engine):
    """Lets the deck name what solves on several ranks."""
    with open(path) as file:
        deck = json.load(file)
    stages = [stage["stage_settings"] if "stage_settings" in stage else stage
              for stage in deck.get("stages", {"": deck}).values()]
    for stage in stages:
        stage["solver_settings"].setdefault("linear_solver_settings", {})["petsc_engine"] = engine
    with open(path, "w") as file:
        json.dump(deck, file)


def busy():
    """Seconds that processors have worked for programs started here and ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def phases(program, source, name, ranks, engine):
    """Seconds of each phase of one run, and its iterations; None when it fails."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = os.path.join(scratch, "deck")
        shutil.copytree(source, folder)
        without_checks(folder, name)
        if engine and ranks > 1:
            with_engine(os.path.join(folder, name), engine)
        command = [program, "run", name, "--threads", "1", "--report", "report.json"]
        environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "RUST_BACKTRACE": "0",
                       "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                       "OMPI_MCA_rmaps_base_oversubscribe": "1"}
        if ranks > 1:
            command = ["mpirun", "--bind-to", "none", "-n", str(ranks)] + command
        before = busy()
        done = subprocess.run(command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, errors="replace")
        used = busy() - before
        if done.returncode != 0:
            print("\n".join(done.stdout.splitlines()[-8:]), file=sys.stderr)
            return None
        with open(os.path.join(folder, "report.json")) as file:
            report = json.load(file)
    seconds = {name: sum(report["seconds"].get(part, 0.0) for part in parts) for name, parts in GROUPS.items()}
    seconds[BUSY] = used
    return seconds, sum(len(step["iterations"]) for step in report["steps"]), report["linear_solver"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("decks", metavar="DECK", nargs="+")
    parser.add_argument("--zelus", default=os.path.join(ROOT, "target", "release", "zelus"))
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--engine", help="petsc_engine of runs on several ranks")
    options = parser.parse_args()
    failed = False
    for deck in options.decks:
        source, name = deck_of(deck)
        best, iterations, engines = {}, {}, {}
        for _ in range(options.rounds):
            for ranks in options.ranks:
                run = phases(os.path.abspath(options.zelus), source, name, ranks, options.engine)
                if run is None:
                    failed = True
                    continue
                seconds, iterations[ranks], engines[ranks] = run
                known = best.setdefault(ranks, seconds)
                best[ranks] = {phase: min(known[phase], seconds[phase]) for phase in seconds}
        done = [ranks for ranks in options.ranks if ranks in best]
        print(f"\n{os.path.basename(source)}: iterations {', '.join(f'{iterations[r]} on {r}' for r in done)}\n")
        print("| phase | " + " | ".join(f"{r} rank{'s' * (r > 1)}, s" for r in done) + " | efficiency |")
        print("|---|" + "---|" * (len(done) + 1))
        for phase in (*GROUPS, BUSY):
            times = [best[r][phase] for r in done]
            ratios = [done[0] * times[0] / (r * t) if t > 0 else float("nan") for r, t in zip(done, times)]
            shown = "" if phase == BUSY else ", ".join(f"{ratio:.2f}" for ratio in ratios[1:])
            print(f"| {phase} | " + " | ".join(f"{t:.3f}" for t in times) + f" | {shown} |")
        for ranks in done:
            print(f"\n{ranks} rank{'s' * (ranks > 1)}: {engines[ranks]}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
