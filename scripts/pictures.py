#!/usr/bin/env python3
"""Runs the problems of docs/gallery.md and draws them into docs/figures/gallery; draws the times of docs/performance.md.

    cargo build --release
    pip install pyvista matplotlib
    scripts/pictures.py [--only TEXT] [--program PATH]

Examples are run as they are, cases of verification/ on the mesh that is named here; in each, a result file with the default output
variables is added. Bodies are drawn as they are deformed, by the factor that the picture states."""
import argparse, importlib.util, json, os, re, shutil, subprocess, sys, tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FIGURES = os.path.join(ROOT, "docs", "figures", "gallery")
sys.path.insert(0, os.path.join(ROOT, "verification"))

STRESS, PRESSURE = "VON_MISES_STRESS", "CONTACT_PRESSURE"
# Name: (variant of the case or None for an example, place of the mesh among those of the case, field, factor of the deformation, zoom on
# where the field is largest)
PROBLEMS = {
    "disc_on_block": (None, 0, STRESS, 1, 4),
    "lug": (None, 0, STRESS, 20, 1),
    "hertz_line_contact": (None, 0, STRESS, 1, 6),
    "hertz_sphere": (None, 0, STRESS, 1, 5),
    "shrink_fit": (None, 0, STRESS, 1, 1),
    "bars_in_thermal_contact": (None, 0, "TEMPERATURE", 0, 1),
    "hertz_in_space": ("ALM", 0, STRESS, 1, 3),
    "cattaneo_mindlin": (0, 1, STRESS, 1, 8),
    "ironing": (0, 0, STRESS, 1, 1),
    "two_arches": (0, 0, STRESS, 1, 1),
    "wavy_surface": (0, 0, STRESS, 1, 2),
    "press_fit": (0, 1, STRESS, 1, 1),
    "tube_torsion": (0, 1, STRESS, 1, 1),
    "punch_rounded": (0, 1, STRESS, 1, 10),
    "shaft_pull_out": (0, 0, STRESS, 1, 1),
    "ring_impact": (0, 0, STRESS, 1, 1),
    "wedge": (0, 1, STRESS, 1, 1),
    "stack_gravity": (0, 0, STRESS, 1, 1),
    "tie_bending": (0, 1, STRESS, 1, 1),
}
VTU = {"python_module": "vtu_output_process", "Parameters": {"model_part_name": "", "output_path": "pictures"}}


def add_output(folder, program, command):
    """Runs a deck of a folder with a result file more, and gives what the program said."""
    path = os.path.join(folder, "ProjectParameters.json")
    with open(path) as file:
        deck = json.load(file)
    process = json.loads(json.dumps(VTU))
    process["Parameters"]["model_part_name"] = deck["solver_settings"]["model_part_name"]
    deck["output_processes"] = {"pictures": [process]}
    with open(path, "w") as file:
        json.dump(deck, file)
    return subprocess.run([program, *command], cwd=folder, capture_output=True, text=True)


def run_example(name, program, folder):
    shutil.copytree(os.path.join(ROOT, "examples", name), folder, dirs_exist_ok=True)
    done = add_output(folder, program, ["run", "ProjectParameters.json"])
    if done.returncode:
        sys.exit(f"{name}: {done.stdout}{done.stderr}")


class Recorder:
    """Stands for `subprocess` in the module that runs cases: their decks get the result file, and their folders stay."""

    TimeoutExpired = subprocess.TimeoutExpired

    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def run(self, command, cwd, **_):
        done = add_output(cwd, self.program, command[1:])
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


def last_result(folder):
    series = [name for name in os.listdir(os.path.join(folder, "pictures")) if name.endswith(".pvd")]
    with open(os.path.join(folder, "pictures", series[0])) as file:
        files = re.findall(r'file="([^"]+)"', file.read())
    return os.path.join(folder, "pictures", files[-1])


def draw(path, field, factor, zoom, to):
    import pyvista
    pyvista.OFF_SCREEN = True
    mesh = pyvista.read(path)
    if factor and "DISPLACEMENT" in mesh.point_data:
        mesh.points = mesh.points + factor * mesh.point_data["DISPLACEMENT"]
    plotter = pyvista.Plotter(off_screen=True, window_size=(460, 400))
    plotter.background_color = "white"
    plotter.add_mesh(mesh, scalars=field, cmap="viridis", show_edges=True, edge_color="white", edge_opacity=0.25,
                     show_scalar_bar=False)
    size = [mesh.bounds[2 * i + 1] - mesh.bounds[2 * i] for i in range(3)]
    if size[2] < 1e-9 * max(size):
        plotter.view_xy()
    else:
        # from the side of the planes of symmetry, which quarter models have at x = 0 and y = 0
        plotter.view_vector((-1, -1, 0.5))
    values = mesh.point_data[field]
    if zoom > 1:
        way = [a - b for a, b in zip(plotter.camera.position, plotter.camera.focal_point)]
        plotter.camera.focal_point = mesh.points[values.argmax()]
        plotter.camera.position = [a + b for a, b in zip(plotter.camera.focal_point, way)]
    plotter.camera.zoom(1.1 * zoom)
    plotter.screenshot(to)
    plotter.close()
    add_bar(to, field, float(values.min()), float(values.max()))
    shrink(to)


def add_bar(path, field, least, most):
    """The colours with their numbers, right of a picture."""
    from matplotlib import colormaps
    from PIL import Image, ImageDraw
    with Image.open(path) as picture:
        whole = Image.new("RGB", (picture.width + 100, picture.height), "white")
        whole.paste(picture.convert("RGB"))
    pen, left, top, height = ImageDraw.Draw(whole), whole.width - 88, 60, 300
    for y in range(height):
        colour = tuple(int(255 * part) for part in colormaps["viridis"](1 - y / (height - 1))[:3])
        pen.line((left, top + y, left + 18, top + y), fill=colour)
    for share in (0, 0.25, 0.5, 0.75, 1):
        pen.text((left + 24, top + (1 - share) * (height - 1) - 6), f"{least + share * (most - least):.3g}", fill="black")
    pen.text((left - 10, 38), field.replace("_", " ").lower(), fill="black")
    whole.save(path)


def shrink(path):
    """Fewer colours, so that a picture takes some tens of kilobytes."""
    from PIL import Image
    with Image.open(path) as image:
        image.convert("RGB").quantize(128).save(path, optimize=True)


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
    figure, axes = plot.subplots(figsize=(7, 4.0), dpi=90)
    axes.barh([p - 0.2 for p in places], own, 0.38, label="zelus", color="#20639b")
    axes.barh([p + 0.2 for p in places], other, 0.38, label="Kratos", color="#c9c9c9")
    for p, a, b in zip(places, own, other):
        axes.text(b, p + 0.2, f" {b / a:.1f}×", va="center", fontsize=8)
    axes.set_xscale("log")
    axes.set_yticks(list(places), names, fontsize=7)
    axes.invert_yaxis()
    axes.set_xlabel("seconds, two threads, both with amgcl (docs/performance.md)", fontsize=8)
    axes.legend(fontsize=8)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    figure.tight_layout()
    figure.savefig(to)
    shrink(to)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", metavar="TEXT")
    parser.add_argument("--program", default=os.path.join(ROOT, "target", "release", "zelus"))
    options = parser.parse_args()
    program = os.path.abspath(options.program)
    os.makedirs(FIGURES, exist_ok=True)
    for name, (variant, mesh, field, factor, zoom) in PROBLEMS.items():
        if options.only not in name:
            continue
        with tempfile.TemporaryDirectory() as folder:
            if variant is None:
                run_example(name, program, folder)
            else:
                run_case(name, variant, mesh, program, folder)
            draw(last_result(folder), field, factor, zoom, os.path.join(FIGURES, name + ".png"))
        print(name, flush=True)
    if options.only in "times":
        draw_times(os.path.join(FIGURES, "times.png"))


if __name__ == "__main__":
    main()
