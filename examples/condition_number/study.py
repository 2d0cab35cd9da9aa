"""Condition number of the system over scale factor k and penalty ε (Table 4.2 and Fig. 4.14 of the specification).

    cargo build --release
    python3 examples/condition_number/study.py [target/release/zelus]

Runs the deck of this folder on scratch copies, writes table.md and, where matplotlib is there, condition_number.png and
condition_number.svg beside it. Ends with an error when one of the conclusions of README.md does not hold."""
import json, os, shutil, subprocess, sys, tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
PROGRAM = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "target", "release", "zelus"))
SCALES = [1.0, 10.0, 100.0, 1e3, 1e4]
PENALTIES = [1e-12, 1e-2, 1.0, 10.0, 100.0, 1e3, 1e4]
ESTIMATE = 10.0  # E/h with E = 100 and h = 10: eq. 4.11 with the factor 1 of the contact processes


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
    lines += [f"| {k:g} | " + " | ".join(f"{found[k, eps]:.3g}" for eps in PENALTIES) + " |" for k in SCALES]
    with open(os.path.join(HERE, "table.md"), "w") as file:
        file.write("\n".join(lines) + "\n")
    print("\n".join(lines))
    draw(found)
    for k in SCALES:
        row = [found[k, eps] for eps in PENALTIES]
        if any(after < 0.98 * before for before, after in zip(row, row[1:])):
            sys.exit(f"k = {k:g}: κ does not grow with ε: {row}")
    for eps in (eps for eps in PENALTIES if eps <= 1.0):
        best = min(SCALES, key=lambda k: found[k, eps])
        if best != ESTIMATE:
            sys.exit(f"ε = {eps:g}: κ is least at k = {best:g}, not at the estimate {ESTIMATE:g}")
    print("κ grows with ε for each k, and is least at k = E/h while ε is small")


main()
