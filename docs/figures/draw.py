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


def penalty():
    """Fig. D.7: (x + 1)² + ε/2 ⟨-x⟩² for the wall x ≥ 0; the minimum moves to the wall as ε grows."""
    x = np.linspace(-1.5, 0.5, 400)
    plt.plot(x, (x + 1) ** 2, "k--", label="no wall")
    for eps in (12.5, 25.0, 37.5, 50.0):
        f = lambda x: (x + 1) ** 2 + 0.5 * eps * np.minimum(x, 0.0) ** 2
        line, = plt.plot(x, f(x), label=f"ε = {eps:g}")
        least = -2.0 / (2.0 + eps)
        plt.plot(least, f(least), "o", color=line.get_color())
    plt.axvspan(-1.5, 0.0, color="0.9")
    plt.xlabel("x"), plt.ylabel("f_p"), plt.ylim(0.0, 4.0), plt.legend()
    save("penalty")


def saddle(scratch, name, functional, tables, title):
    """Contours of a functional of (u, λ) and the paths of Newton's method on it, the wall moved to u = -0.9."""
    u, multiplier = np.meshgrid(np.linspace(-1.05, 0.05, 81), np.linspace(-0.06, 0.5, 81))
    plt.contour(u, multiplier, functional(u, multiplier), 15, cmap="viridis", linewidths=0.8)
    plt.colorbar(label=title)
    for (table, label), mark in zip(tables, ("o-", "s--")):
        path = iterates(scratch, "moved_wall", table)
        plt.plot(path[:, 0], path[:, 1], mark, markersize=4, label=label)
    plt.plot(-0.9, -0.001, "r*", markersize=12, label="solution")
    plt.xlabel("u"), plt.ylabel("λ"), plt.legend(loc="upper right")
    save(name)


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
        spring = lambda u: 0.25 * (u + 1) ** 4
        penalty()
        saddle(decks, "multipliers", lambda u, l: spring(u) + l * (u + 0.9),
               [("d8", "strategy 1"), ("d9", "strategy 2 stalls")], "Lagrangian")
        eps = 0.5
        saddle(decks, "augmented_lagrangian",
               lambda u, l: spring(u) + np.where(l + eps * (u + 0.9) <= 0, l * (u + 0.9) + 0.5 * eps * (u + 0.9) ** 2,
                                                 -0.5 / eps * l ** 2),
               [("d11", "ε = 0.5")], "augmented Lagrangian, ε = 0.5")
        residuals(decks)
    finally:
        shutil.rmtree(scratch)


main()
