#!/usr/bin/env python3
"""Time zelus and the reference program on the same decks and print a markdown table.

    compare.py [--zelus PROGRAM] [--threads 2] [--rounds 3] [--ours DECK] DECK...

A DECK is a ProjectParameters.json or its folder. Both programs run on a scratch copy, by turns, and the time is that
of the whole process; the table gives the shortest of the rounds, of the time on the clock and of the time processors
were busy with it. The latter means something on a machine that does other work as well; take it with one thread, since
waiting threads of the reference count as busy. Comparisons with stored results, and output in a
format that one program does not know, are left out. `--ours` names a deck that zelus runs in place of the one DECK
(say, one that differs in the linear solver). A run that fails shows as such and ends in exit code 1.

The reference is found by the environment: KRATOS_PYTHON is a Python that has KratosMultiphysics with the structural
and the contact application. KRATOS_RUN may name a script that runs a deck given as its argument; without it a
plain structural-mechanics analysis is run. Without KRATOS_PYTHON only zelus is timed, and the script says so.
"""
import argparse
import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
REFERENCE = """
import os, sys
import KratosMultiphysics as KM
KM.Logger.GetDefaultOutput().SetSeverity(KM.Logger.Severity.WARNING)
import KratosMultiphysics.LinearSolversApplication
import KratosMultiphysics.ContactStructuralMechanicsApplication
from KratosMultiphysics.StructuralMechanicsApplication.structural_mechanics_analysis import StructuralMechanicsAnalysis
parameters = KM.Parameters(open(sys.argv[1]).read())
StructuralMechanicsAnalysis(KM.Model(), parameters).Run()
sys.stdout.flush()
os._exit(0)
"""


def deck_of(path):
    """The folder of a deck and the name of its file."""
    if os.path.isdir(path):
        path = os.path.join(path, "ProjectParameters.json")
    if not os.path.isfile(path):
        sys.exit(f"there is no deck {path}")
    return os.path.split(os.path.abspath(path))


def without_checks(folder, name):
    """Takes out of a deck what is no part of the work, or what only one of the programs knows."""
    path = os.path.join(folder, name)
    with open(path) as file:
        deck = json.load(file)
    for part in ("processes", "output_processes"):
        for key, items in list(deck.get(part, {}).items()):
            if isinstance(items, list):
                names = ("from_json_check_result_process", "json_output_process", "vtu_output_process", "check_")
                deck[part][key] = [i for i in items if not str(i.get("python_module", "")).startswith(names)]
    with open(path, "w") as file:
        json.dump(deck, file, indent=1)


def busy():
    """Processor seconds of the processes that have ended."""
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    return ended.ru_utime + ended.ru_stime


def seconds(command, source, name, threads):
    """Seconds on the clock and of processors of a run on a scratch copy of the deck; None when it fails."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = os.path.join(scratch, "deck")
        shutil.copytree(source, folder)
        without_checks(folder, name)
        limits = {"OMP_NUM_THREADS": str(threads), "RAYON_NUM_THREADS": str(threads), "RUST_BACKTRACE": "0"}
        environment = {**os.environ, **limits}
        begin, busy_before = time.perf_counter(), busy()
        done = subprocess.run(command + [name], cwd=folder, env=environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, errors="replace")
        spent = time.perf_counter() - begin, busy() - busy_before
    if done.returncode != 0:
        print("\n".join(done.stdout.splitlines()[-8:]), file=sys.stderr)
        return None
    return spent


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("decks", nargs="+", metavar="DECK")
    parser.add_argument("--ours", metavar="DECK", help="what zelus runs instead of the one DECK")
    parser.add_argument("--zelus", default=os.path.join(ROOT, "target", "release", "zelus"))
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()
    if options.ours and len(options.decks) != 1:
        parser.error("--ours goes with one DECK")
    zelus = os.path.abspath(options.zelus)
    if not os.path.isfile(zelus):
        sys.exit(f"there is no {zelus}; build it with `cargo build --release`, or name another with --zelus")
    python = os.environ.get("KRATOS_PYTHON")
    if python:
        script = os.environ.get("KRATOS_RUN")
        reference = [python, os.path.abspath(script)] if script else [python, "-c", REFERENCE]
    else:
        reference = None
        print("KRATOS_PYTHON is not set: the reference program is skipped", file=sys.stderr)

    print(f"Whole process, {options.threads} threads, shortest of {options.rounds} alternating rounds.\n")
    print("| deck | zelus, s | reference, s | ratio | zelus, processor s | reference, processor s | ratio |")
    print("|---|---:|---:|---:|---:|---:|---:|")
    failed = False
    for path in options.decks:
        theirs = deck_of(path)
        ours = deck_of(options.ours) if options.ours else theirs
        rounds = {"zelus": [], "reference": []}
        for _ in range(options.rounds):
            rounds["zelus"].append(seconds([zelus, "run", "--threads", str(options.threads)], *ours, options.threads))
            if reference:
                rounds["reference"].append(seconds(reference, *theirs, options.threads))
        failed |= any(None in spent for spent in rounds.values())

        def columns(which):
            """Both times and their ratio, of the clock (0) or of processors (1)."""
            times = [None if None in spent or not spent else min(s[which] for s in spent) for spent in rounds.values()]
            words = [
                f"{best:.3g}" if best is not None else "failed" if None in spent else "skipped"
                for best, spent in zip(times, rounds.values())
            ]
            ratio = "–" if None in times or not times[0] else f"{times[1] / times[0]:.1f}"
            return f"{words[0]} | {words[1]} | {ratio}"

        name = os.path.relpath(theirs[0], os.path.dirname(os.path.dirname(theirs[0])))
        print(f"| {name} | {columns(0)} | {columns(1)} |", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
