"""Rows of the atlas: errors, observed orders, verdicts; the table of docs/verification.md."""
import math, os, re

from . import svg

LONGEST = 300  # letters of the reason for a miss


class Row:
    pass


def rows_of(name, case, runs):
    """One row for each variant and quantity, from the runs {(case, variant, level): (outcome, message)}."""
    rows = []
    for variant in case.variants:
        levels = sorted(level for _, v, level in runs if v == variant)
        if not levels:
            continue
        done = {level: runs[name, variant, level] for level in levels}
        broken = [f"mesh {case.meshes[level]}: {message}" for level, (_, message) in done.items() if message]
        nothing = not any(outcome for outcome, _ in done.values())
        for quantity in case.quantities[:1] if nothing else case.quantities:
            if quantity.published is not None and callable(quantity.published) and quantity.published(case.variants[variant]) is None:
                continue
            row = Row()
            row.case, row.variant, row.quantity, row.levels = name, variant, quantity, levels
            row.published = quantity.published(case.variants[variant]) if callable(quantity.published) else quantity.published
            row.values = {l: done[l][0].values.get(quantity.name) for l in levels if done[l][0]}
            row.values = {l: v for l, v in row.values.items() if v is not None}
            if not row.values and not nothing:
                continue
            row.errors = {l: quantity.error(v, case.variants[variant]) for l, v in row.values.items()}
            row.broken, last = broken, levels[-1]
            row.tolerance = quantity.tolerance_of(last, variant)
            row.iterations = done[last][0].iterations if done[last][0] else None
            row.cuts = done[last][0].cuts if done[last][0] else None
            good = lambda e, l: math.isfinite(e) and abs(e) <= quantity.tolerance_of(l, variant)
            row.passed = not broken and all(good(row.errors[l], l) for l in levels if l in row.errors) and last in row.errors
            row.order = order_of(case, row) if quantity.order else None
            wide = [f"mesh {case.meshes[l]}: {e:.1e}" for l, e in row.errors.items() if not good(e, l)]
            row.reason = "" if row.passed else "; ".join(broken + (["off by " + ", ".join(wide)] if wide else []))
            row.known = case.known.get(variant, case.known.get("", ""))
            rows.append(row)
    return rows


def order_of(case, row):
    """Slope of log error over log size, from the first to the last mesh; None where errors are round-off."""
    levels = [l for l in sorted(row.errors) if abs(row.errors[l]) > 1e-9]
    if len(levels) < 2:
        return None
    first, last = levels[0], levels[-1]
    ratio = case.size(case.meshes[first]) / case.size(case.meshes[last])
    return math.log(abs(row.errors[first] / row.errors[last])) / math.log(ratio)


def number(x):
    if x is None:
        return "–"
    return f"{x:.5g}"


def cells(row):
    last = max(row.levels)
    value = row.values.get(last)
    error = row.errors.get(last)
    return [row.quantity.name + (f" [{row.quantity.unit}]" if row.quantity.unit else ""), number(row.published), number(value),
            "–" if error is None else f"{error:.1e}", f"{row.tolerance:.0e}", "–" if row.order is None else f"{row.order:.1f}",
            "–" if row.iterations is None else str(row.iterations), "–" if row.cuts is None else str(row.cuts)]


def line(row):
    verdict = "ok  " if row.passed else "MISS"
    title = row.case + ("/" + row.variant if row.variant else "")
    c = cells(row)
    text = (f"{verdict} {title:44.44} {c[0]:32.32} published {c[1]:>10} computed {c[2]:>11} error {c[3]:>8} (tol {c[4]}) order {c[5]:>4} "
            f"iterations {c[6]:>4} cuts {c[7]}")
    return text + (f"\n       {row.reason[:160]}" if not row.passed else "")


def picture(name, case, runs):
    """Panels for a case: the deformed coarsest mesh, curves of the finest, convergence of the numbers that converge."""
    panels = []
    of = lambda variant: [(level, runs[name, variant, level][0]) for level in range(len(case.meshes)) if runs.get((name, variant, level), (None,))[0]]
    for variant in dict.fromkeys([case.picture, *case.variants]):
        done = of(variant)
        if done:
            last = done[0][1].last
            if last is not None and last.model is not None and last.model.bodies:
                panels.append(svg.mesh(last.model, last))
            if done[-1][1].curves:
                panels.append(svg.curves(done[-1][1].curves, *(done[-1][1].labels or ())))
            break
    series = {}
    for quantity in case.quantities:
        for variant in dict.fromkeys([case.picture, *case.variants]):
            errors = [(case.size(case.meshes[level]), abs(quantity.error(o.values[quantity.name], case.variants[variant])))
                      for level, o in of(variant) if o.values.get(quantity.name) is not None]
            errors = [e for e in errors if e[1] > 1e-9 and math.isfinite(e[1])]
            if quantity.order and len(errors) > 1 and len(series) < 5:
                series[quantity.name + (f", {variant}" if variant and variant != case.picture else "")] = errors
            if errors:
                break
    if series:
        panels.append(svg.convergence(series))
    return svg.page(panels) if panels else None


HEAD = """# Verification atlas

For users who judge the accuracy of zelus. After this page you know errors, orders of convergence, iterations and cuts of published problems.

The problems are run with the default settings of zelus, except for the variant that a row names. Validation against experiments is not
part of it. This page is written by

    cargo build --release
    python3 verification/run.py --write

and every number on it comes from that command, which ends with an error where a row misses its tolerance; `--only TEXT` runs the
cases with that text in their name. A quick part (the coarsest meshes of some variants) is in the test command
(`tests/pages/atlas.rs`). Each case is a folder of `verification` with a script that makes the mesh and the deck; how to add one is in
[verification/README.md](../verification/README.md).

*Published* is the reference; its tag is ANALYTIC (closed form), EXTERNAL (another program or a published table) or
REGRESSION (an earlier result of this program). *Error* is that of the finest mesh, relative to the published value or to the unit in which
the row is given. *Order* is the slope of log error over log mesh size from the first to the last mesh, where the error is a discretisation
error.
*Iterations* and *cuts* are those of the whole run on the finest mesh. A row passes when every mesh is within its tolerance.
"""


def write(docs, cases, rows, runs):
    """docs/verification.md and docs/figures/verification/*.svg."""
    folder = os.path.join(docs, "figures", "verification")
    os.makedirs(folder, exist_ok=True)
    missed = [r for r in rows if not r.passed]
    out = [HEAD]
    out.append(f"{len(cases)} cases, {len(rows)} numbers, {len(rows) - len(missed)} within their tolerance, {len(missed)} not.\n")
    out.append("| case | numbers | within tolerance | tag |\n|---|---|---|---|")
    for name, case in cases.items():
        mine = [r for r in rows if r.case == name]
        anchor = re.sub(r"[^\w\- ]", "", case.title.lower()).replace(" ", "-")
        out.append(f"| [{case.title}](#{anchor}) | {len(mine)} | {sum(r.passed for r in mine)} | {case.tag} |")
    if missed:
        out.append("\n## Cases outside their tolerance\n\n| case | variant | number | error | reason |\n|---|---|---|---|---|")
        for r in missed:
            error = r.errors.get(max(r.errors)) if r.errors else None
            out.append(f"| `{r.case}` | {r.variant or '–'} | {r.quantity.name} | {'–' if error is None else f'{error:.1e}'} | {said(r)} |")
    for name, case in cases.items():
        out.append(f"\n## {case.title}\n\n*{case.source}.* {case.tag}. {case.why}" + (f"\n\n{case.note}" if case.note else ""))
        drawing = picture(name, case, runs)
        if drawing:
            with open(os.path.join(folder, name + ".svg"), "w") as file:
                file.write(drawing)
            out.append(f"\n![{case.title}](figures/verification/{name}.svg)")
        out.append(f"\n`python3 verification/run.py --only {name}`, meshes {', '.join(str(m) for m in case.meshes)}\n")
        out.append("| variant | number | published | computed | error | tolerance | order | iterations | cuts | |\n|---|---|---|---|---|---|---|---|---|---|")
        for r in rows:
            if r.case == name:
                out.append(f"| {r.variant or '–'} | " + " | ".join(cells(r)) + f" | {'' if r.passed else '**misses**'} |")
    with open(os.path.join(docs, "verification.md"), "w") as file:
        file.write("\n".join(out) + "\n")


def said(row):
    """The reason for a miss, for a cell of a table."""
    reason = (row.known + "; " if row.known else "") + row.reason
    reason = re.sub(r"error\[[\w-]+\] ", "", reason).split("; largest residual")[0]
    return reason.replace("|", "/").replace("\n", " ")[:LONGEST]
