#!/usr/bin/env python3
"""Draws the pictures of the documents: those of docs/gallery.md, of the objects of assemblies, and the chart of docs/performance.md.

    cargo build --release
    pip install gmsh matplotlib
    scripts/pictures.py [--only TEXT] [--program PATH]

Each problem is run with a result file of the default output variables, and `zelus report --picture` draws it: examples as they are,
cases of verification/ on the mesh that is named here, assemblies as scripts/assemblies.py writes their decks. gmsh meshes the lug in space,
matplotlib draws the chart."""
import argparse, importlib.util, json, os, shutil, subprocess, sys, tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FIGURES = os.path.join(ROOT, "docs", "figures")
sys.path.insert(0, os.path.join(ROOT, "verification"))

N_MM = "--unit N/mm²"
# Name: options of the picture, and deck of the example or (variant, place of the mesh among those of the case).
EXAMPLES = {
    "lug": (f"--mirror x --mirror z --cut z=0.01 --view 1,-0.35,0.9 --factor 5 --inset 4 {N_MM}", "InSpace.json"),
    "disc_on_block": (f"--mirror x --inset 5 --factor 1 --width 1500 {N_MM}", "ProjectParameters.json"),
    "hertz_line_contact": (f"--mirror x --inset 8 --factor 1 {N_MM}", "ProjectParameters.json"),
    "hertz_sphere": (f"--mirror x --mirror y --cut y=0.001 --factor 1 --inset 6 {N_MM}", "ProjectParameters.json"),
    "gear_pair": (f"--factor 1 --inset 12 {N_MM}", "ProjectParameters.json"),
    "rubber_seal": (f"--mirror x --mirror y --factor 1 {N_MM}", "ProjectParameters.json"),
    "shrink_fit": (f"--mirror x --mirror y --factor 1 --width 1200 {N_MM}", "ProjectParameters.json"),
    "brake_disc": ("--revolve 270 --field TEMPERATURE --factor 1", "ProjectParameters.json"),
    "bars_in_thermal_contact": ("--field TEMPERATURE", "ProjectParameters.json"),
}
CASES = {
    "tube_torsion": ("--factor 5 --view -0.5,-1,0.8", ("ALM", 2)),
    "shaft_pull_out": ("--revolve 270 --factor 20 --width 1500", ("ALM", 1)),
    "hertz_in_space": ("--mirror x --mirror y --cut y=0.001 --factor 1 --inset 4", ("ALM", 0)),
    "press_fit": ("--mirror x --mirror y --factor 1 --width 1200", (0, 1)),
    "cattaneo_mindlin": ("--inset 8 --factor 1", (0, 1)),
    "ironing": ("--step all --width 800 --factor 1", ("μ = 0.3, 30 steps", 1)),
    "two_arches": ("--factor 1", (0, 0)),
    "wavy_surface": ("--mirror x --inset 3 --factor 1", (0, 0)),
    "punch_rounded": ("--mirror x --inset 10 --factor 1", (0, 1)),
    "ring_impact": ("--factor 1", (0, 0)),
    "wedge": ("--factor 1", (0, 1)),
    "stack_gravity": ("", (0, 0)),
    "tie_bending": ("", (0, 1)),
}
ASSEMBLIES = {
    "kinematic_coupling": f"--view 1,-0.5,0.35 {N_MM}",
    "distributing_coupling": f"--view 0.4,-1,0.35 {N_MM}",
    "resultant": f"--view -0.5,-1,0.6 {N_MM}",
    "slope": "--field DISPLACEMENT --unit mm --view -0.3,-1,0.3",
    "cyclic_sector": f"--view -0.3,-0.5,1 {N_MM}",
    "orthotropic_tube": "--mirror y --field DISPLACEMENT --unit mm --view 0.6,-1,0.5",
    "rigid_body": f"--view 1,-0.5,0.35 {N_MM}",
    "clearance": f"--view -0.2,-0.6,1 --width 1200 {N_MM}",
    "ground_springs": "--field DISPLACEMENT --unit mm --view -0.5,-1,0.8",
    "cylindrical_support": f"--view 0.4,-1,0.35 {N_MM}",
    "hardening": "--mirror x --mirror y --field EQUIVALENT_PLASTIC_STRAIN",
    "creep": "--mirror x --mirror y --field EQUIVALENT_CREEP_STRAIN",
    "spherical_support": f"--view -0.2,-1,0.3 --mirror y {N_MM}",
    "pyramids": f"--view -0.6,-1,0.5 --width 1400 {N_MM}",
    "bolt": f"--view -0.3,-1,0.45 --factor 20 --width 1400 {N_MM}",
}
VTU = {"python_module": "vtu_output_process", "Parameters": {"model_part_name": "", "output_path": "pictures"}}


def prepare(folder, deck_name):
    """Adds a result file with the default variables to a deck that has none."""
    path = os.path.join(folder, deck_name)
    with open(path) as file:
        deck = json.load(file)
    process = json.loads(json.dumps(VTU))
    solver = deck["solver_settings"]
    parts = [solver, *(own for own in solver.values() if isinstance(own, dict))]
    process["Parameters"]["model_part_name"] = next(own["model_part_name"] for own in parts if "model_part_name" in own)
    for key in ("output_processes", "processes"):
        for name, listed in deck.get(key, {}).items():
            deck[key][name] = [own for own in listed if not own.get("python_module", "").startswith("vt")]
    deck.setdefault("output_processes", {})["pictures"] = [process]
    with open(path, "w") as file:
        json.dump(deck, file)


def run_example(name, deck_name, program, folder):
    shutil.copytree(os.path.join(ROOT, "examples", name), folder, dirs_exist_ok=True)
    if name == "lug":
        import gmsh
        gmsh.initialize(interruptible=False)
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(os.path.join(folder, "lug_in_space.geo"))
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        gmsh.write(os.path.join(folder, "lug_in_space.msh"))
        gmsh.finalize()
    prepare(folder, deck_name)
    run_deck(deck_name, program, folder)


def run_deck(deck_name, program, folder):
    done = subprocess.run([program, "run", deck_name, "--report", "report.json"], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{folder}: {done.stdout}{done.stderr}")


class Recorder:
    """Stands for `subprocess` in the module that runs cases: their decks get the result file, and their folders stay."""

    TimeoutExpired = subprocess.TimeoutExpired

    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def run(self, command, cwd, **_):
        prepare(cwd, command[2])
        done = subprocess.run([self.program, *command[1:]], cwd=cwd, capture_output=True, text=True)
        shutil.copytree(cwd, self.folder, dirs_exist_ok=True)
        return done


def run_case(name, variant, mesh, program, folder):
    from lib import solution
    spec = importlib.util.spec_from_file_location(name, os.path.join(ROOT, "verification", name, "case.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    case = module.CASE
    solution.PROGRAM, solution.subprocess = program, Recorder(program, folder)
    variants = list(case.variants)
    case.solve(case.meshes[mesh], **case.variants[variant if variant in variants else variants[0]])


def run_assembly(name, program, folder):
    """Runs a deck of scripts/assemblies.py; the folder with its report."""
    import assemblies
    from lib import solution
    if name in assemblies.GMSH:
        folder = assemblies.GMSH[name](program, folder)
        prepare(folder, "ProjectParameters.json")
        run_deck("ProjectParameters.json", program, folder)
        return folder
    scratch = os.path.join(folder, "run")
    solution.PROGRAM, solution.subprocess = program, Recorder(program, scratch)
    assemblies.write(name, program, os.path.join(folder, "deck"))
    return scratch


def draw(folder, options, program, to):
    """The picture of the run of a folder."""
    os.makedirs(os.path.dirname(to), exist_ok=True)
    # a picture of another program is not replaced
    if os.path.exists(to):
        os.remove(to)
    done = subprocess.run([program, "report", "report.json", "--picture", to, *options.split()], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{to}: {done.stdout}{done.stderr}")
    print(os.path.relpath(to, ROOT), os.path.getsize(to) // 1000, "kB", flush=True)


def draw_times(to):
    """The first table of docs/performance.md as bars: seconds of the clock."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plot
    with open(os.path.join(ROOT, "docs", "performance.md")) as file:
        rows = [line.split("|")[1:-1] for line in file if line.startswith("|")]
    head = next(at for at, row in enumerate(rows) if "zelus, s" in row[2])
    names, own, other, last = [], [], [], ""
    for row in rows[head + 2:]:
        if len(row) != len(rows[head]):
            break
        last = row[0].strip() or last
        names.append(f"{last}\n{row[1].strip()} unknowns")
        own.append(float(row[2]))
        other.append(float(row[3].split("(")[0]))
    places = range(len(names))
    figure, axes = plot.subplots(figsize=(10, 0.62 * len(names) + 0.9), dpi=160)
    axes.barh([p - 0.2 for p in places], own, 0.38, label="zelus", color="#0bb1c9")
    axes.barh([p + 0.2 for p in places], other, 0.38, label="Kratos", color="#c3c7cf")
    for p, a, b in zip(places, own, other):
        axes.text(b, p + 0.2, f" {b / a:.1f}×", va="center", fontsize=10)
    axes.set_xscale("log")
    axes.set_yticks(list(places), names, fontsize=9)
    axes.invert_yaxis()
    axes.set_xlabel("seconds, two threads, both with amgcl (docs/performance.md)", fontsize=10)
    axes.legend(fontsize=10)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    figure.tight_layout()
    figure.savefig(to)
    print(os.path.relpath(to, ROOT), os.path.getsize(to) // 1000, "kB", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", metavar="TEXT")
    parser.add_argument("--program", default=os.path.join(ROOT, "target", "release", "zelus"))
    options = parser.parse_args()
    program = os.path.abspath(options.program)
    gallery = os.path.join(FIGURES, "gallery")
    for name, (words, source) in {**EXAMPLES, **CASES}.items():
        if options.only not in name:
            continue
        with tempfile.TemporaryDirectory() as folder:
            if name in EXAMPLES:
                run_example(name, source, program, folder)
            else:
                run_case(name, *source, program, folder)
            draw(folder, words, program, os.path.join(gallery, name + ".png"))
    for name, words in ASSEMBLIES.items():
        if options.only in name:
            with tempfile.TemporaryDirectory() as folder:
                draw(run_assembly(name, program, folder), words, program, os.path.join(FIGURES, "assemblies", name + ".png"))
    if options.only in "times":
        draw_times(os.path.join(gallery, "times.png"))


if __name__ == "__main__":
    main()
