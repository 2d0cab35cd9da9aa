#!/usr/bin/env python3
"""Runs the verification atlas: cases with published answers, by the program as it is built.

    cargo build --release
    python3 verification/run.py [--only TEXT] [--quick] [--write] [--jobs N] [--program PATH]

Prints for each case what is published, computed, the error, the observed order, iterations and cuts. `--only` runs the cases
whose folder has TEXT in its name (and, after a slash, in its variant); `--quick` the coarsest mesh of the cases of the test
command; `--write` writes docs/verification.md and its pictures. The exit status is 1 where a case misses its tolerance."""
import argparse, concurrent.futures, importlib.util, multiprocessing, os, sys, traceback

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)
sys.path.insert(0, HERE)
from lib import solution, table  # noqa: E402


CASES = {}  # by folder; processes that run them inherit it


def load(only):
    """Cases by folder, in the order of their names."""
    cases = {}
    for name in sorted(os.listdir(HERE)):
        path = os.path.join(HERE, name, "case.py")
        if name != "lib" and os.path.exists(path) and only.split("/")[0] in name:
            spec = importlib.util.spec_from_file_location("case_" + name, path)
            module = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(module)
            cases[name] = module.CASE
    return cases


def one(name, variant, level):
    """One run: (outcome, None) or (None, message)."""
    case = CASES[name]
    try:
        return case.solve(case.meshes[level], **case.variants[variant]), None
    except solution.Failed as failed:
        return None, str(failed)
    except Exception as error:  # a script that breaks is a failure of its case, not of the others
        return None, f"script: {error!r} {traceback.format_exc().splitlines()[-3].strip()}"


def work(cases, quick, only):
    """All runs, as (case, variant, level)."""
    chosen = only.partition("/")[2]
    for name, case in cases.items():
        if quick and not case.quick:
            continue
        for variant in case.variants:
            if chosen not in variant or (quick and isinstance(case.quick, (list, tuple)) and variant not in case.quick):
                continue
            for level in range(1 if quick else len(case.meshes)):
                yield name, variant, level


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", metavar="TEXT")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--jobs", type=int, default=max(1, (os.cpu_count() or 2) // 2))
    parser.add_argument("--program", default=os.path.join(ROOT, "target", "release", "zelus"))
    options = parser.parse_args()
    solution.PROGRAM = os.path.abspath(options.program)
    if not os.path.exists(solution.PROGRAM):
        sys.exit(f"{solution.PROGRAM} is not there: cargo build --release")
    if options.write and (options.only or options.quick):
        sys.exit("--write writes the whole table: leave out --only and --quick")
    CASES.update(load(options.only))
    cases = CASES
    todo = list(work(cases, options.quick, options.only))
    if not todo:
        sys.exit(f"no case has {options.only!r} in its name")
    # slow cases and the finest meshes first, so that no long run is left at the end
    order = sorted(todo, key=lambda w: (not cases[w[0]].slow, -w[2]))
    with concurrent.futures.ProcessPoolExecutor(options.jobs, multiprocessing.get_context("fork")) as pool:
        runs = {w: pool.submit(one, *w) for w in order}
        rows = []
        for name in cases:
            made = table.rows_of(name, cases[name], {w: runs[w].result() for w in todo if w[0] == name})
            for row in made:
                print(table.line(row), flush=True)
            rows += made
    missed = [r for r in rows if not r.passed]
    failing = sorted({r.case for r in missed})
    print(f"{len(cases)} cases, {len(todo)} runs, {len(rows)} numbers, {len(missed)} missed" + (": " + ", ".join(failing) if failing else ""))
    if options.write:
        table.write(os.path.join(ROOT, "docs"), cases, rows, {w: r.result() for w, r in runs.items()})
    sys.exit(1 if missed else 0)


if __name__ == "__main__":
    main()
