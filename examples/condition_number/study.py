"""Condition number of the system over scale factor k and penalty ε (Table 4.2 and Fig. 4.14 of the specification).

    cargo build --release
    python3 examples/condition_number/study.py [target/release/zelus]

Runs the deck of this folder on scratch copies, writes table.md with the printed numbers beside and, where matplotlib is
there, condition_number.png and condition_number.svg. Ends with an error when one of the conclusions of README.md does not
hold."""
import json, os, shutil, subprocess, sys, tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
PROGRAM = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "target", "release", "zelus"))
SCALES = [1.0, 10.0, 100.0, 1e3, 1e4]
PENALTIES = [1e-12, 1e-2, 1.0, 10.0, 100.0, 1e3, 1e4]
ESTIMATE = 100.0  # E/h with E = 100 and h = 1: eq. 4.11 with the factor 1 of the contact processes
# Table 4.2 by rows of k, in the order of PENALTIES.
PRINTED = {
    1.0: [1.13e5, 1.13e5, 1.13e5, 1.18e5, 1.63e5, 6.15e5, 2.69e7],
    10.0: [1.74e4, 1.74e4, 1.74e4, 1.74e4, 1.74e4, 1.74e4, 2.69e5],
    100.0: [1.74e4, 1.74e4, 1.74e4, 1.74e4, 1.74e4, 1.74e4, 9.38e4],
    1e3: [6.60e4, 6.60e4, 5.75e5, 1.92e4, 1.81e4, 3.14e4, 6.43e4],
    1e4: [6.64e5, 6.63e5, 6.63e5, 6.63e5, 3.53e5, 3.26e6, 7.38e5],
}


def condition_number(k, eps):
    """That of the last system of the run, contact closed."""
    with tempfile.TemporaryDirectory() as folder:
        for name in ("ProjectParameters.json", "StructuralMaterials.json", "condition_number.mdpa"):
            shutil.copy(os.path.join(HERE, name), folder)
        path = os.path.join(folder, "ProjectParameters.json")
        with open(path) as file:
            deck = json.load(file)
        contact = deck["processes"]["contact_process_list"][0]["Parameters"]
        contact["advance_ALM_parameters"].update(scale_factor=k, penalty=eps)
        del deck["output_processes"]
        with open(path, "w") as file:
            json.dump(deck, file)
        done = subprocess.run([PROGRAM, "run", path, "--report", "report.json"], cwd=folder, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"k = {k:g}, ε = {eps:g}: {done.stdout}{done.stderr}")
        with open(os.path.join(folder, "report.json")) as file:
            return json.load(file)["steps"][-1]["iterations"][-1]["condition_number"]


def draw(found):
    try:
        import matplotlib
    except ImportError:
        return print("no picture: python3 -m pip install matplotlib")
    matplotlib.use("agg")
    import matplotlib.pyplot as plt
    import numpy as np
    matplotlib.rcParams["svg.hashsalt"] = "zelus"
    kappa = np.array([[found[k, eps] for k in SCALES] for eps in PENALTIES[1:]])
    plt.contourf(SCALES, PENALTIES[1:], np.log10(kappa), 20, cmap="viridis")
    plt.colorbar(label="log₁₀ κ")
    plt.plot(ESTIMATE, ESTIMATE, "r*", markersize=12, label="k = ε = E/h")
    plt.xscale("log"), plt.yscale("log"), plt.xlabel("scale factor k"), plt.ylabel("penalty ε"), plt.legend()
    for end in ("png", "svg"):
        plt.savefig(os.path.join(HERE, "condition_number." + end), metadata={"Date": None} if end == "svg" else None)


def main():
    found = {(k, eps): condition_number(k, eps) for k in SCALES for eps in PENALTIES}
    lines = ["| k \\ ε | " + " | ".join(f"{eps:g}" for eps in PENALTIES) + " |", "|---" * (len(PENALTIES) + 1) + "|"]
    for k in SCALES:
        lines.append(f"| {k:g} | " + " | ".join(f"{found[k, eps]:.3g}" for eps in PENALTIES) + " |")
        lines.append("| printed | " + " | ".join(f"{kappa:.3g}" for kappa in PRINTED[k]) + " |")
    with open(os.path.join(HERE, "table.md"), "w") as file:
        file.write("\n".join(lines) + "\n")
    print("\n".join(lines))
    draw(found)
    for k in SCALES:
        row = [found[k, eps] for eps in PENALTIES]
        if any(after < (1 - 1e-6) * before for before, after in zip(row, row[1:])):
            sys.exit(f"k = {k:g}: κ does not grow with ε: {row}")
    # κ ≥ k σ/μ, which it comes to as k grows (README.md).
    bound = 0.98 * found[SCALES[-1], PENALTIES[0]] / SCALES[-1]
    for (k, eps), kappa in found.items():
        if kappa < bound * k:
            sys.exit(f"k = {k:g}, ε = {eps:g}: κ = {kappa:g} is below k σ/μ = {bound * k:g}")
    # The valley: between 10 and 100, where κ is that of the bodies; beyond it κ rises with k and with 1/k.
    for k, eps in ((k, eps) for k in (10.0, 100.0) for eps in PENALTIES if eps <= 100.0):
        if abs(found[k, eps] / 1.74e4 - 1.0) > 0.03:
            sys.exit(f"k = {k:g}, ε = {eps:g}: κ is {found[k, eps]:.3g}, not that of the printed valley, 1.74e4")
    for eps in (eps for eps in PENALTIES if eps <= 100.0):
        if min(found[1.0, eps], found[1e3, eps]) < 3.0 * found[ESTIMATE, eps]:
            sys.exit(f"ε = {eps:g}: κ does not rise on both sides of the valley")
    # The row k = 1, over three decades.
    for eps, printed in zip(PENALTIES, PRINTED[1.0]):
        if not 0.5 < found[1.0, eps] / printed < 2.0:
            sys.exit(f"k = 1, ε = {eps:g}: κ is {found[1.0, eps]:.3g}, printed {printed:.3g}")
    print("κ grows with ε for each k, the valley and the row k = 1 are those of Table 4.2")


main()
