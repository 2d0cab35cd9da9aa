"""Writes the expected.json of every folder: the iterates of each table, computed apart from zelus.

    python3 make_expected.py            (standard library only)

Plain Newton iterations with 60 digits, each method written out for its own problem. A residual norm that is zero in
exact arithmetic is left to `round_off`, the size of what double precision may leave."""
import json
from decimal import Decimal as D
from decimal import getcontext
from pathlib import Path

getcontext().prec = 60
HERE = Path(__file__).parent
TENTH = D(1) / 10


def norm(*entries):
    return sum(e * e for e in entries).sqrt()


def row(*values, norm):
    return {"values": [float(v) for v in values], "residual_norm": float(norm)}


# One spring, f' = slope(x), f'' = bend(x), wall at w; g = x - w >= 0, pressure is lam <= 0.
LINEAR = dict(slope=lambda x: 2 * (x + 1), bend=lambda x: D(2), wall=D(0), start=D(1))
QUARTIC = dict(slope=lambda x: x**3, bend=lambda x: 3 * x**2, wall=D(1), start=D(1))
MOVED = dict(slope=lambda u: (u + 1) ** 3, bend=lambda u: 3 * (u + 1) ** 2, wall=D(-9) / 10, start=D(0))


def penalty(eps, solves, slope, bend, wall, start):
    x, rows = start, []
    for _ in range(solves + 1):
        g = x - wall
        force, stiffness = (eps * g, eps) if g < 0 else (D(0), D(0))
        r = slope(x) + force
        rows.append(row(x, norm=abs(r)))
        x -= r / (bend(x) + stiffness)
    return rows


def adapted_penalty(eps, low, high, solves, slope, bend, wall, start):
    x, rows = start, []
    for i in range(solves + 1):
        g = x - wall
        if i > 0 and g < 0:
            eps *= -g / high if -g > high else -g / low if -g < low else 1
        force, stiffness = (eps * g, eps) if g < 0 else (D(0), D(0))
        r = slope(x) + force
        rows.append(row(x, eps, norm=abs(r)))
        x -= r / (bend(x) + stiffness)
    return rows


def multiplier(strategy, solves, slope, bend, wall, start, checked=False, sign=1, doubled=False):
    """Active: [f'' 1; 1 0] [dx; dlam] = -[f' + lam; g]; otherwise lam keeps its value."""
    rule = {1: lambda g, lam: g <= 0, 2: lambda g, lam: lam <= 0, 3: lambda g, lam: g <= 0 or lam < 0}[strategy]
    x, lam, rows = start, D(0), []
    active = checked and rule(x - wall, lam)
    for _ in range(solves + 1):
        g = x - wall
        r, held = slope(x) + (lam if active else 0), (g if active else D(0))
        values = (x, lam / 2, lam / 2) if doubled else (x, sign * lam)
        rows.append(row(*values, norm=norm(r, held, held) if doubled else norm(r, held)))
        dx = -g if active else -r / bend(x)
        if active:
            lam -= r + bend(x) * dx
        x += dx
        active = rule(x - wall, lam)
    return rows


def algorithm_7(eps, g, previous, limit):
    """As the reference program reads Algorithm 7."""
    if g * previous < 0:
        if abs(previous) > limit:
            return abs(eps * previous / g * (abs(g) + limit) / (g - previous))
        return abs(eps * previous / (10 * g))
    if abs(g) <= limit:
        return eps
    growth = (abs(g) / limit - 1).sqrt() + 1
    if abs(g - previous) > max(g / 10, previous, 5 * limit):
        return 2 * eps
    if abs(g) < 10 * limit:
        return eps * growth**2
    if abs(g) > D("1.01") * abs(previous):
        return abs(2 * eps * previous / g)
    return eps * growth


def augmented(eps, solves, slope, bend, wall, start, limit=None):
    x, lam, previous, rows = start, D(0), None, []
    for i in range(solves + 1):
        g = x - wall
        if limit and i > 0 and min(g, previous) < 0:
            eps = algorithm_7(eps, g, previous, limit)
        previous = g
        active = lam + eps * g <= 0
        r, held = slope(x) + (lam + eps * g if active else 0), (g if active else -lam / eps)
        rows.append(row(*((x, lam, eps) if limit else (x, lam)), norm=norm(r, held)))
        dx = -g if active else -r / bend(x)
        lam = lam - r - (bend(x) + eps) * dx if active else D(0)
        x += dx
    return rows


def uzawa(eps, solves, slope, bend, wall, start, limit=None):
    x, lam, previous, active, rows = start, D(0), None, False, []
    for i in range(solves + 1):
        g = x - wall
        if active:
            lam = min(D(0), lam + eps * g)
            if limit and min(g, previous) < 0:
                eps = algorithm_7(eps, g, previous, limit)
        previous = g
        active = lam + eps * g <= 0
        r = slope(x) + (lam + eps * g if active else 0)
        rows.append(row(*((x, lam, eps) if limit else (x, lam)), norm=abs(r)))
        x -= r / (bend(x) + (eps if active else 0))
    return rows


# The problem of eq. D.26: minimum of |x - (6, 7)|^2 under a.x + b <= 0.
TARGET = (D(6), D(7))
CONSTRAINTS = ((D(-3), D(-2), D(6)), (D(-1), D(1), D(-3)), (D(1), D(1), D(-7)), (D(2) / 3, D(-1), D(-4) / 3))


def over_constrained_penalty(eps, solves):
    x, rows = (D(0), D(0)), []
    for _ in range(solves + 1):
        r = [2 * (x[i] - TARGET[i]) for i in range(2)]
        h = [[D(2), D(0)], [D(0), D(2)]]
        for a in CONSTRAINTS:
            g = a[0] * x[0] + a[1] * x[1] + a[2]
            if g > 0:
                for i in range(2):
                    r[i] += eps * g * a[i]
                    for j in range(2):
                        h[i][j] += eps * a[i] * a[j]
        rows.append(row(*x, norm=norm(*r)))
        det = h[0][0] * h[1][1] - h[0][1] * h[1][0]
        x = (x[0] - (h[1][1] * r[0] - h[0][1] * r[1]) / det, x[1] - (h[0][0] * r[1] - h[1][0] * r[0]) / det)
    return rows


def deck(name, source, columns, iterates, round_off, printed=(), exit_code=0, says=()):
    """`printed`: (iterate, column or "residual_norm", value, relative tolerance) as the specification prints them."""
    keys = ("iterate", "what", "value", "relative_tolerance")
    return {
        "deck": name, "source": source, "exit_code": exit_code, "says": list(says), "columns": columns,
        "round_off": round_off, "printed": [dict(zip(keys, p)) for p in printed], "iterates": iterates,
    }


def write(folder, decks):
    texts = []
    for entry in decks:
        iterates = ",\n".join("      " + json.dumps(r) for r in entry.pop("iterates"))
        printed = ",\n".join("      " + json.dumps(r) for r in entry.pop("printed"))
        head = ",\n".join(f"    {json.dumps(k)}: {json.dumps(v)}" for k, v in entry.items())
        printed = f"[\n{printed}\n    ]" if printed else "[]"
        texts.append(f'  {{\n{head},\n    "printed": {printed},\n    "iterates": [\n{iterates}\n    ]\n  }}')
    (HERE / folder / "expected.json").write_text("[\n" + ",\n".join(texts) + "\n]\n")


NORM = "residual_norm"
write("linear_spring", [
    deck("table_d2.json", "Table D.2", ["x"], penalty(D(10) ** 6, 2, **LINEAR), 1e-9,
         [(0, NORM, 4, 1e-12), (1, NORM, 1e6, 1e-12), (0, "x", 1, 1e-12), (1, "x", -1, 1e-12), (2, "x", -2e-6, 1e-5)]),
    deck("table_d3.json", "Table D.3", ["x", "lambda"], multiplier(2, 1, **LINEAR, checked=True), 1e-15,
         [(0, NORM, 4.12311, 1.3e-6), (1, "lambda", -2, 1e-12)]),
])
write("quartic_spring", [
    deck(f"table_d{3 + s}.json", f"Table D.{3 + s}", ["x", "lambda"], multiplier(s, 3, **QUARTIC, sign=-1), 1e-15,
         [(3, "x", 1, 1e-12), (3, "lambda", 1, 1e-12)])
    for s in (1, 2, 3)
])
ends = [(8, "u", -0.9, 1e-12), (8, "lambda", -0.001, 1e-9)]
write("moved_wall", [
    deck("table_d7.json", "Table D.7", ["u"], penalty(D(10) ** 6, 8, **MOVED), 1e-9,
         [(6, NORM, 12208.5, 1e-6), (8, "u", -0.9, 1e-8)]),
    deck("table_d8.json", "Table D.8", ["u", "lambda"], multiplier(1, 8, **MOVED), 1e-15, ends),
    deck("table_d9.json", "Table D.9", ["u", "lambda"], multiplier(2, 10, **MOVED), 1e-15,
         [(10, "u", -0.996, 2e-4), (10, "lambda", 0.459259, 1e-6), (10, NORM, 5.9e-8, 1e-2)], 3,
         ["not converged in 10 iterations"]),
    deck("table_d10.json", "Table D.10", ["u", "lambda"], multiplier(3, 8, **MOVED), 1e-15, ends),
] + [
    deck(f"table_d{n}.json", f"Table D.{n}", ["u", "lambda"], augmented(D(eps), 8, **MOVED), 1e-14, ends + threshold)
    for n, eps, threshold in (
        (11, "0.5", []), (12, "1", [(6, NORM, 0.0168, 3e-3)]), (13, "5", [(6, NORM, 0.0616, 1e-3)]),
        (14, "10", [(6, NORM, 0.122, 1e-3)]))
])
four = ["lambda1", "lambda2", "lambda3", "lambda4"]
free = 2 * norm(*TARGET)
write("over_constrained", [
    deck("table_d15.json", "Table D.15", ["x1", "x2"], over_constrained_penalty(2 * D(10) ** 6, 3), 1e-8,
         [(0, NORM, float(2 * D(468000384000085).sqrt()), 1e-12), (1, NORM, 14.4222, 1e-5), (2, NORM, 1.69706e7, 1e-5),
          (2, "x1", 6, 1e-12), (2, "x2", 7, 1e-12), (3, "x1", 3, 1e-6), (3, "x2", 4, 1e-6)]),
    deck("equation_d28.json", "Equation D.28", ["x1", "x2"] + four, [row(*[0] * 6, norm=free)], 1e-15, [], 4,
         ["singular: its rank is 2, its size 6"]),
    deck("held_strategy_1.json", "eqs. D.5, D.26", ["x1", "x2"] + four,
         [row(*[0] * 6, norm=free), row(6, 7, *[0] * 4, norm=6), row(3, 4, 0, 0, 6, 0, norm=0)], 1e-14),
    deck("held_strategy_2.json", "eqs. D.5, D.26", ["x1", "x2"] + four,
         [row(*[0] * 6, norm=free), row(6, 7, *[0] * 4, norm=norm(*[6 * a + 7 * b + c for a, b, c in CONSTRAINTS]))],
         1e-14, [], 4, ["singular: its rank is 4, its size 6"]),
])
write("further_methods", [
    deck("adapted_penalty.json", "eq. D.4", ["x", "epsilon"],
         adapted_penalty(D(1), D("1e-4"), D("1e-2"), 7, **LINEAR), 1e-12),
    deck("uzawa.json", "eqs. D.10a–c", ["x", "lambda"], uzawa(D(18), 10, **LINEAR), 1e-14),
    deck("adapted_uzawa.json", "eqs. D.10a–c, Algorithm 7", ["x", "lambda", "epsilon"],
         uzawa(D(18), 8, **LINEAR, limit=D("1e-3")), 1e-12),
    deck("adapted_augmented_lagrangian.json", "eq. D.22, Algorithm 7", ["u", "lambda", "epsilon"],
         augmented(D("0.5"), 8, **MOVED, limit=D("1e-3")), 1e-13),
    deck("double_lagrange_multiplier.json", "Lagrange doubles", ["u", "lambda1", "lambda2"],
         multiplier(1, 8, **MOVED, doubled=True), 1e-15),
    # The residual is that of the equations that are left: along x2 = 7 - x1 at (6, 7), none at the wall.
    deck("master_slave_elimination.json", "eqs. D.12a–e, D.26", ["x1", "x2", "lambda3"],
         [row(0, 0, 0, norm=free), row(6, 7, 0, norm=0), row(3, 4, 6, norm=0)], 1e-14),
    deck("eliminated_wall.json", "eqs. D.12a–e, D.13", ["x", "lambda"],
         [row(1, 0, norm=4), row(-1, 0, norm=0), row(0, -2, norm=0)], 1e-15),
])
