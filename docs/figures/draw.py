"""Draws the figures of the theory pages, as SVG beside this file.

    python3 -m pip install matplotlib
    cargo build --release
    python3 docs/figures/draw.py [target/release/zelus]

The iterates in them are those zelus computes: the decks of examples/spring_and_wall are run on a scratch copy."""
import json, os, shutil, subprocess, sys, tempfile

import matplotlib
matplotlib.use("svg")
matplotlib.rcParams.update({"svg.hashsalt": "zelus", "figure.figsize": (6.4, 4.2), "axes.grid": True, "grid.alpha": 0.3})
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
PROGRAM = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "target", "release", "zelus"))


def iterates(scratch, folder, table):
    """Iterates of one table's deck, a row each; a deck that must fail leaves its iterates too."""
    path = os.path.join(scratch, folder)
    subprocess.run([PROGRAM, "run", f"table_{table}.json"], cwd=path, capture_output=True)
    with open(os.path.join(path, f"iterates_{table}.json")) as file:
        return np.array([row["values"] for row in json.load(file)["iterates"]])


def save(name):
    plt.tight_layout()
    plt.savefig(os.path.join(HERE, name + ".svg"), metadata={"Date": None})
    plt.close()
    print(os.path.relpath(os.path.join(HERE, name + ".svg"), os.getcwd()))


def adaptation():
    """Fig. D.2: the factor of the adapted penalty over the penetration (eq. D.4)."""
    least, most = 1.0, 2.0
    g = np.linspace(0.0, 4.0, 400)
    factor = np.where(g > most, g / most, np.where(g < least, g / least, 1.0))
    plt.plot(g, factor)
    plt.xticks([0.0, least, most], ["0", "g_min", "g_max"]), plt.yticks([0.0, 1.0, 2.0])
    plt.xlabel("|g|"), plt.ylabel("factor of ε")
    save("adapted_penalty")


def contact_lagrangians():
    """Figs. D.3 and D.4: terms of contact over gap and multiplier; with a multiplier alone it has a kink, augmented it has none."""
    g, multiplier = np.meshgrid(np.linspace(-1.0, 1.0, 17), np.linspace(-1.0, 1.0, 17))
    eps = 1.0
    closed = multiplier + eps * g <= 0.0
    augmented = np.where(closed, multiplier * g + 0.5 * eps * g ** 2, -0.5 / eps * multiplier ** 2)
    plain = np.where(multiplier <= 0.0, multiplier * g, 0.0)
    figure = plt.figure(figsize=(9.0, 4.2))
    for at, (values, title) in enumerate([(plain, "λ g where λ ≤ 0 (Fig. D.3)"), (augmented, "augmented, ε = 1 (Fig. D.4)")]):
        axes = figure.add_subplot(1, 2, at + 1, projection="3d")
        axes.plot_surface(g, multiplier, values, cmap="viridis", linewidth=0.2, edgecolor="0.4", alpha=0.7)
        if at == 1:
            border = np.linspace(-1.0, 1.0, 25)
            axes.plot(border, -eps * border, -0.5 * eps * border ** 2, "r", label="λ + ε g = 0"), axes.legend()
        axes.set_xlabel("g"), axes.set_ylabel("λ"), axes.set_title(title)
    save("contact_lagrangians")


def springs():
    """Fig. D.6: the spring without load, extended, and kept by the wall."""
    figure, axes = plt.subplots(figsize=(6.4, 3.2))
    for at, (end, title) in enumerate([(1.0, "unloaded"), (1.6, "extended by Δx"), (1.3, "kept by the wall")]):
        middle = 2.0 * at
        coil = np.linspace(0.0, 1.0, 160)
        swing = 0.18 * np.sin(2.0 * np.pi * 8.0 * coil) * (coil > 0.1) * (coil < 0.9)
        axes.plot(middle + swing, -end * coil, "k", linewidth=1.0)
        axes.plot(middle, -end, "o", color="C0", markersize=10)
        axes.plot([middle - 0.5, middle + 0.5], [0.0, 0.0], "k", linewidth=3)
        axes.text(middle, 0.12, title, ha="center")
        if at == 1:
            axes.annotate("", (middle + 0.35, -end), (middle + 0.35, -1.0), arrowprops={"arrowstyle": "->"})
            axes.text(middle + 0.42, -1.35, "Δx")
        if at == 2:
            axes.fill_between([middle - 0.5, middle + 0.5], -1.55, -1.38, color="0.7")
    axes.set_xlim(-0.8, 4.8), axes.set_ylim(-1.9, 0.35), axes.axis("off")
    save("springs")


def penalties(name, spring, wall, shown, eps_of, limits):
    """Figs. D.7 and D.12: a spring with ε/2 ⟨wall − x⟩² for the wall x ≥ `wall`; the minimum moves to the wall as ε grows."""
    x = np.linspace(*shown, 2000)
    plt.plot(x, spring(x), "k--", label="no wall")
    for eps in eps_of:
        values = spring(x) + 0.5 * eps * np.minimum(x - wall, 0.0) ** 2
        line, = plt.plot(x, values, label=f"ε = {eps:g}")
        plt.plot(x[values.argmin()], values.min(), "o", color=line.get_color())
    plt.axvspan(shown[0], wall, color="0.9")
    plt.xlabel("x"), plt.ylabel("f_p"), plt.ylim(*limits), plt.legend()
    save(name)


def saddles(scratch, name, folder, panels, shown, solution):
    """Contours of functionals of position and multiplier, and the paths of Newton's method on them: a panel each.

    A panel is a functional of both, the table whose iterates are drawn, and a title."""
    figure, axes = plt.subplots(1, len(panels), figsize=(3.4 * max(len(panels), 2), 3.6), sharey=True, squeeze=False)
    x, multiplier = np.meshgrid(np.linspace(*shown[0], 61), np.linspace(*shown[1], 61))
    for own, (functional, table, title) in zip(axes[0], panels):
        own.contour(x, multiplier, functional(x, multiplier), 14, cmap="viridis", linewidths=0.8)
        path = iterates(scratch, folder, table)
        own.plot(path[:, 0], path[:, 1], "o-", color="C1", markersize=4, label=f"Table {table.upper()[0]}.{table[1:]}")
        own.plot(*solution, "r*", markersize=12, label="solution")
        own.set_xlim(*shown[0]), own.set_ylim(*shown[1]), own.set_title(title, fontsize=10), own.set_xlabel("position")
    axes[0][0].set_ylabel("λ"), axes[0][-1].legend(loc="best", fontsize=8)
    save(name)


def strategies(spring, gap, sign):
    """The Lagrangian spring + λ g under the strategies 1, 2 and 3 (eqs. D.18–D.20); λ presses where `sign` λ is negative."""
    def lagrangian(active):
        return lambda x, multiplier: spring(x) + np.where(active(gap(x), sign * multiplier), sign * multiplier * gap(x), 0.0)
    return [lagrangian(lambda g, l: g <= 0.0), lagrangian(lambda g, l: l <= 0.0), lagrangian(lambda g, l: (g <= 0.0) | (l < 0.0))]


def augmented(spring, gap, eps):
    """The augmented Lagrangian (eq. D.22)."""
    def functional(x, multiplier):
        g = gap(x)
        return spring(x) + np.where(multiplier + eps * g <= 0.0, multiplier * g + 0.5 * eps * g ** 2, -0.5 / eps * multiplier ** 2)
    return functional


def over_constrained(scratch):
    """Fig. D.20: the objective, the region that the four constraints leave, and the path of Table D.15."""
    x, y = np.meshgrid(np.linspace(-0.5, 7.0, 301), np.linspace(-0.5, 8.0, 301))
    constraints = [-3 * x - 2 * y + 6, -x + y - 3, x + y - 7, 2 / 3 * x - y - 4 / 3]
    plt.contour(x, y, (x - 6) ** 2 + (y - 7) ** 2, 14, cmap="viridis", linewidths=0.8)
    plt.contourf(x, y, np.max(constraints, axis=0), levels=[-100.0, 0.0], colors="C2", alpha=0.25)
    for at, constraint in enumerate(constraints):
        plt.contour(x, y, constraint, levels=[0.0], colors="0.3", linewidths=1.0)
    path = iterates(scratch, "over_constrained", "d15")
    plt.plot(path[:, 0], path[:, 1], "o-", color="C1", markersize=4, label="Table D.15")
    plt.plot(3.0, 4.0, "r*", markersize=12, label="solution")
    plt.xlabel("x₁"), plt.ylabel("x₂"), plt.legend(loc="upper left")
    save("over_constrained")


def elimination(scratch):
    """Fig. D.5: the patch test of unlike meshes by constraints; its displacement is uniform, which weights of each row alone miss."""
    figure, axes = plt.subplots(1, 2, figsize=(8.4, 3.6), sharey=True)
    for own, consistent in zip(axes, (False, True)):
        folder = os.path.join(scratch, f"elimination_{consistent}")
        shutil.copytree(os.path.join(ROOT, "tests", "cases", "contact_2d", "nonmatching"), folder)
        path = os.path.join(folder, "ProjectParameters.json")
        with open(path) as file:
            deck = json.load(file)
        del deck["solver_settings"]["contact_settings"]
        deck["solver_settings"].update(mpc_contact_settings={"contact_type": "Frictionless"}, convergence_criterion="residual_criterion")
        contact = deck["processes"]["contact_process_list"][0]
        contact["python_module"] = "mpc_contact_process"
        contact["Parameters"]["consistent_weights"] = consistent
        deck["processes"]["json_output_process_list"] = deck["processes"]["json_output_process_list"][:2]
        with open(path, "w") as file:
            json.dump(deck, file)
        done = subprocess.run([PROGRAM, "run", path], cwd=folder, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(done.stdout + done.stderr)
        for body, mark, first, last in (("upper", "o-", 13, 18), ("lower", "s--", 9, 12)):
            with open(os.path.join(folder, body + ".json")) as file:
                results = json.load(file)
            ids = range(first, last + 1)
            places = np.linspace(0.0, 1.0, len(ids))
            values = [1e3 * results[f"NODE_{node}"]["DISPLACEMENT_Y"][-1] for node in ids]
            own.plot(places, values, mark, markersize=4, label=f"{body} body")
        own.set_title("consistent weights" if consistent else "weights row by row", fontsize=10), own.set_xlabel("x")
    axes[0].set_ylabel("displacement of the interface, 10⁻³"), axes[0].legend()
    save("elimination")


def residuals(scratch):
    """Norms of the residual by iteration: strategies of the multiplier method and the augmented Lagrangian."""
    for table, label in (("d7", "penalty, ε = 10⁶"), ("d8", "multiplier, strategy 1"), ("d9", "multiplier, strategy 2"),
                         ("d11", "augmented, ε = 0.5"), ("d14", "augmented, ε = 10")):
        path = os.path.join(scratch, "moved_wall")
        iterates(scratch, "moved_wall", table)
        with open(os.path.join(path, f"iterates_{table}.json")) as file:
            norms = [row["residual_norm"] for row in json.load(file)["iterates"]]
        plt.semilogy(range(len(norms)), np.maximum(norms, 1e-20), "o-", markersize=4, label=label)
    plt.xlabel("solve"), plt.ylabel("norm of the residual"), plt.legend()
    save("moved_wall")


def main():
    scratch = tempfile.mkdtemp()
    try:
        decks = os.path.join(scratch, "spring_and_wall")
        shutil.copytree(os.path.join(ROOT, "examples", "spring_and_wall"), decks)
        quartic = lambda x: 0.25 * x ** 4
        moved, wall = lambda u: 0.25 * (u + 1) ** 4, lambda u: u + 0.9
        adaptation()
        contact_lagrangians()
        springs()
        elimination(scratch)
        penalties("penalty", lambda x: (x + 1) ** 2, 0.0, (-1.5, 0.5), (12.5, 25.0, 37.5, 50.0), (0.0, 4.0))
        penalties("penalty_moved_wall", moved, -0.9, (-1.15, -0.6), (0.05, 0.2, 1.0, 5.0), (0.0, 0.006))
        saddles(decks, "linear_spring", "linear_spring",
                [(lambda x, l: (x + 1) ** 2 + np.minimum(l, 0.0) * x, "d3", "f + min(0, λ) x")], ((-1.5, 1.5), (-4.0, 1.0)), (0.0, -2.0))
        panels = zip(strategies(quartic, lambda x: x - 1.0, -1.0), ("d4", "d5", "d6"), (f"strategy {n}" for n in (1, 2, 3)))
        saddles(decks, "quartic_spring", "quartic_spring", list(panels), ((0.0, 2.0), (-0.5, 2.0)), (1.0, 1.0))
        panels = zip(strategies(moved, wall, 1.0), ("d8", "d9", "d10"), (f"strategy {n}" for n in (1, 2, 3)))
        saddles(decks, "multipliers", "moved_wall", list(panels), ((-1.05, 0.05), (-0.06, 0.5)), (-0.9, -0.001))
        panels = [(augmented(moved, wall, eps), table, f"ε = {eps:g}")
                  for eps, table in ((0.5, "d11"), (1.0, "d12"), (5.0, "d13"), (10.0, "d14"))]
        saddles(decks, "augmented_lagrangian", "moved_wall", panels, ((-1.05, 0.05), (-0.06, 0.5)), (-0.9, -0.001))
        over_constrained(decks)
        residuals(decks)
    finally:
        shutil.rmtree(scratch)


main()
