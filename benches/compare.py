#!/usr/bin/env python3
"""Time zelus and other programs on the same decks and print a markdown table.

    compare.py [--threads 2] [--rounds 3] [DECK...]
    compare.py --blocks 8 16 24 [--kinds frictionless friction] [--steps 1]
    compare.py --lugs 1,1 2,2 --arches 4,1 4,2 4,1,0

A DECK is a ProjectParameters.json or its folder; `--blocks` names sizes of the decks of gen_blocks.py instead (cells along an edge of
the lower block: 8 are 3,000 unknowns, 60 a million), `--lugs` those of gen_lug.py (edge of the cells and their order), and `--arches`
those of gen_arches.py (cells through the thickness, their order, and the friction where it is not that of the script). All programs run
on scratch copies, alternately, and times are those of the whole process, the shortest of the rounds, on the clock and of the processors.
The latter means something on a machine that does other work as well; take it with one thread, since waiting threads of the reference
count as busy. Memory is the largest of the process. Comparisons with stored results, and output in a format that one program does not
know, are left out. `--ours` names a deck that zelus runs in place of the one DECK (say, one that differs in the linear solver). A run
that fails, or takes longer than --limit, shows as such and ends in exit code 1.

The reference is KratosMultiphysics: that of the Python that the environment names (KRATOS_PYTHON), or else one that is
installed into target/reference by pip, once. `--alone` times zelus only. KRATOS_RUN may name a script that runs a
deck given as its argument; without it a plain structural-mechanics analysis is run. Of the kind `body`, of lugs and of arches CalculiX
solves the same mesh, too, where `ccx` is installed, and of the kind `frictionless`, of lugs and of arches GetFEM (getfem_contact.py), where
the package python3-getfem is: in the Python that GETFEM_PYTHON names, in this one or in /usr/bin/python3. `--programs` selects among them.

Lugs and arches have columns of force: the largest sum of REACTION_X, and the last after a slash. Programs that solve the same problem agree
in it.
"""
import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import venv

import gen_arches
import gen_blocks
import gen_lug

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PACKAGES = ["KratosMultiphysics", "KratosStructuralMechanicsApplication", "KratosContactStructuralMechanicsApplication",
            "KratosConstitutiveLawsApplication", "KratosLinearSolversApplication", "KratosConvectionDiffusionApplication"]
# Kinds that the reference does not solve with amgcl: it takes its own default solver.
SOLVERS = {"friction": "", "components": ""}
REFERENCE = """
import os, sys
import KratosMultiphysics as KM
KM.Logger.GetDefaultOutput().SetSeverity(KM.Logger.Severity.WARNING)
import KratosMultiphysics.LinearSolversApplication
try:
    import KratosMultiphysics.ConstitutiveLawsApplication
except ImportError:
    pass
import KratosMultiphysics.ContactStructuralMechanicsApplication
from KratosMultiphysics.StructuralMechanicsApplication.structural_mechanics_analysis import StructuralMechanicsAnalysis
parameters = KM.Parameters(open(sys.argv[1]).read())
if parameters.Has("analysis_stage"):
    from KratosMultiphysics.ConvectionDiffusionApplication.convection_diffusion_analysis import ConvectionDiffusionAnalysis
    ConvectionDiffusionAnalysis(KM.Model(), parameters).Run()
else:
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
                deck[part][key] = [i for i in items if not str(i.get("python_module", "")).startswith(names)
                                   or i.get("Parameters", {}).get("output_file_name") == "reaction.json"]
    with open(path, "w") as file:
        json.dump(deck, file, indent=1)


def measured(command, folder, threads, limit):
    """Seconds on the clock, seconds of processors and megabytes of a run in `folder`; None when it fails."""
    limits = {"OMP_NUM_THREADS": str(threads), "RAYON_NUM_THREADS": str(threads), "RUST_BACKTRACE": "0"}
    said = os.path.join(folder, "said.txt")
    begin = time.perf_counter()
    with open(said, "w") as out:
        run = subprocess.Popen(command, cwd=folder, env={**os.environ, **limits}, stdout=out, stderr=subprocess.STDOUT)
        timer = threading.Timer(limit, run.kill)
        timer.start()
        _, status, used = os.wait4(run.pid, 0)
        timer.cancel()
        run.returncode = os.waitstatus_to_exitcode(status)
    spent = time.perf_counter() - begin
    if run.returncode != 0:
        with open(said, errors="replace") as file:
            print("\n".join(file.read().splitlines()[-8:]), file=sys.stderr)
        return None
    return spent, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def iterations_of(path):
    """Unknowns, Newton iterations and linear iterations of a run of zelus, in words; from its report."""
    with open(path) as file:
        report = json.load(file)
    linear = [i["linear_iterations"] for step in report["steps"] for i in step["iterations"]]
    mean = sum(linear) / max(len(linear), 1)
    return report["sizes"]["unknowns"], f"{len(linear)} × {mean:.0f}"


def force_of(folder):
    """Largest and last sum of REACTION_X in reaction.json or in the file of CalculiX, in words; None when a run wrote none."""
    path, sums = os.path.join(folder, "reaction.json"), []
    if os.path.isfile(path):
        with open(path) as file:
            nodes = [v["REACTION_X"] for v in json.load(file).values() if isinstance(v, dict)]
        sums = [sum(own) for own in zip(*nodes)]
    for name in os.listdir(folder):
        if name.endswith(".dat"):
            with open(os.path.join(folder, name)) as file:
                lines = [line.split() for line in file]
            sums = [float(after[0]) for line, after in zip(lines, lines[2:]) if line[:2] == ["total", "force"]]
    return f"{max(map(abs, sums)):.4g} / {abs(sums[-1]):.4g}" if sums else None


def one_round(command, deck, threads, limit):
    """A run on a scratch copy of the deck, what the report says if there is one, and the force."""
    folder, name = deck
    with tempfile.TemporaryDirectory() as scratch:
        copy = os.path.join(scratch, "deck")
        shutil.copytree(folder, copy)
        without_checks(copy, name)
        done = measured(command, copy, threads, limit)
        report = os.path.join(copy, "report.json")
        return done, iterations_of(report) if done and os.path.isfile(report) else None, force_of(copy) if done else None


def python_of_reference():
    """The Python with the reference program, installed here if there is none."""
    named = os.environ.get("KRATOS_PYTHON")
    if named:
        return named
    folder = os.path.join(ROOT, "target", "reference")
    python = os.path.join(folder, "bin", "python")
    there = os.path.isfile(python) and subprocess.run(
        [python, "-c", "import KratosMultiphysics.ContactStructuralMechanicsApplication"],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0
    if not there:
        print(f"installing the reference program into {folder}", file=sys.stderr)
        venv.create(folder, with_pip=True)
        subprocess.run([python, "-m", "pip", "install", "-q", *PACKAGES], check=True, stdout=sys.stderr)
    return python


def python_of_getfem():
    """A Python that has GetFEM, None if there is none."""
    for python in filter(None, (os.environ.get("GETFEM_PYTHON"), sys.executable, "/usr/bin/python3")):
        if shutil.which(python) and subprocess.run([python, "-c", "import getfem"], stderr=subprocess.DEVNULL).returncode == 0:
            return python
    return None


def columns(rounds, which, form):
    """Costs of each program, the smallest of its rounds, and the ratio of the others to zelus."""
    best = {name: None if None in done or not done else min(r[which] for r in done) for name, done in rounds.items()}
    words = []
    for name, value in best.items():
        text = "–" if not rounds[name] else "failed" if value is None else format(value, form)
        if name != "zelus" and value is not None and best["zelus"]:
            text += f" ({value / best['zelus']:.1f})"
        words.append(text)
    return " | ".join(words)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("decks", nargs="*", metavar="DECK")
    parser.add_argument("--blocks", type=int, nargs="+", default=[], metavar="CELLS")
    parser.add_argument("--kinds", nargs="+", choices=gen_blocks.KINDS, default=["frictionless"])
    parser.add_argument("--lugs", nargs="+", default=[], metavar="SIZE,ORDER")
    parser.add_argument("--arches", nargs="+", default=[], metavar="CELLS,ORDER[,FRICTION]")
    others = ["Kratos", "CalculiX", "GetFEM"]
    parser.add_argument("--programs", nargs="+", choices=others, default=others, help="beside zelus")
    parser.add_argument("--steps", type=int, default=1, help="steps of the blocks")
    parser.add_argument("--solver", help="linear solver that the blocks name, instead of what the reference is fastest with")
    parser.add_argument("--ours", metavar="DECK", help="what zelus runs instead of the one DECK")
    parser.add_argument("--alone", action="store_true", help="zelus only")
    parser.add_argument("--zelus", default=os.path.join(ROOT, "target", "release", "zelus"))
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--limit", type=float, default=3600.0, help="seconds after which a run is ended")
    options = parser.parse_args()
    if options.ours and len(options.decks) != 1:
        parser.error("--ours goes with one DECK")
    if not (options.decks or options.blocks or options.lugs or options.arches):
        parser.error("name decks, or sizes with --blocks, --lugs or --arches")
    zelus = os.path.abspath(options.zelus)
    if not os.path.isfile(zelus):
        sys.exit(f"there is no {zelus}; build it with `cargo build --release`, or name another with --zelus")
    programs = {"zelus": [zelus, "run", "--threads", str(options.threads), "--report", "report.json"]}
    if not options.alone and "Kratos" in options.programs:
        python, script = python_of_reference(), os.environ.get("KRATOS_RUN")
        programs["Kratos"] = [python, os.path.abspath(script)] if script else [python, "-c", REFERENCE]
    drawn = options.lugs or options.arches
    wanted = lambda name, kind: not options.alone and name in options.programs and (drawn or kind in options.kinds and options.blocks)
    ccx = shutil.which("ccx") if wanted("CalculiX", "body") else None
    getfem = python_of_getfem() if wanted("GetFEM", "frictionless") else None
    names = [*programs, *(["CalculiX"] if ccx else []), *(["GetFEM"] if getfem else [])]

    print(f"Whole process, {options.threads} threads, best of {options.rounds} alternating rounds; in brackets the ratio to zelus.\n")
    heads = [f"{name}, {what}" for what in ("s", "processor s", "MB") for name in names]
    heads += [f"{name}, force" for name in names] if drawn else []
    print("| deck | unknowns | " + " | ".join(heads) + " | Newton × linear iterations |")
    print("|---|---:|" + "---:|" * (len(heads) + 1), flush=True)
    failed = False
    with tempfile.TemporaryDirectory() as made:
        decks = [(deck_of(path), os.path.relpath(deck_of(path)[0], os.path.dirname(os.path.dirname(deck_of(path)[0]))), None)
                 for path in options.decks]
        for kind in options.kinds:
            for cells in options.blocks:
                folder = os.path.join(made, f"{kind}-{cells}")
                solver = SOLVERS.get(kind, "amgcl") if options.solver is None else options.solver
                # In a process of its own: what this one takes would count as that of the programs it starts.
                asked = ["--lower", str(cells), "--upper", str(cells * 3 // 4), "--kind", kind, "--steps", str(options.steps)]
                subprocess.run([sys.executable, gen_blocks.__file__, folder, *asked, "--solver", solver], check=True,
                               stdout=subprocess.DEVNULL)
                steps = f", {options.steps} steps" if options.steps > 1 else ""
                decks.append(((folder, "ProjectParameters.json"), f"{kind}, {cells}{steps}", kind))
        for size, order in (lug.split(",") for lug in options.lugs):
            folder = os.path.join(made, f"lug-{size}-{order}")
            asked = ["--size", size, "--order", order, "--zelus", zelus, *(["--solver", options.solver] if options.solver else [])]
            subprocess.run([sys.executable, gen_lug.__file__, folder, *asked], check=True, stdout=subprocess.DEVNULL)
            decks.append(((folder, "ProjectParameters.json"), f"lug, {size} mm, order {order}", "lug"))
        for arches in options.arches:
            cells, order, *friction = arches.split(",")
            folder = os.path.join(made, f"arches-{arches}")
            asked = ["--cells", cells, "--order", order, *(["--friction", *friction] if friction else []),
                     *(["--solver", options.solver] if options.solver else [])]
            subprocess.run([sys.executable, gen_arches.__file__, folder, *asked], check=True, stdout=subprocess.DEVNULL)
            words = f", friction {friction[0]}" if friction else ""
            decks.append(((folder, "ProjectParameters.json"), f"arches, {cells} cells, order {order}{words}", "arches"))
        for theirs, label, kind in decks:
            rounds, forces, said = {name: [] for name in names}, dict.fromkeys(names, "–"), None
            for _ in range(options.rounds):
                for name in names:
                    deck = deck_of(options.ours) if options.ours and name == "zelus" else theirs
                    if name == "CalculiX":
                        files = [name[:-4] for name in os.listdir(theirs[0]) if name.endswith(".inp")]
                        if not files:
                            continue
                        command = [ccx, "-i", files[0]]
                    elif name == "GetFEM":
                        if kind not in ("frictionless", "lug", "arches"):
                            continue
                        command = [getfem, os.path.join(ROOT, "benches", "getfem_contact.py"), deck[1]]
                    else:
                        command = programs[name] + [deck[1]]
                    done, report, force = one_round(command, deck, options.threads, options.limit)
                    rounds[name].append(done)
                    said = report or said
                    if force and kind in ("lug", "arches"):
                        forces[name] = force
                    failed |= done is None
            unknowns, iterations = said or ("", "")
            cells = [columns(rounds, 0, ".3g"), columns(rounds, 1, ".3g"), columns(rounds, 2, ".0f"), *(forces.values() if drawn else [])]
            print(f"| {label} | {unknowns} | {' | '.join(cells)} | {iterations} |", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
