"""Numbers read from solutions: errors against fields, pressures, balances."""
import math


def affine_error(solution, body, gradient, fixed=None):
    """Largest departure of a body's displacement from the affine field of a displacement gradient, over the field's largest
    difference; rigid translations of the body do not count. `fixed` lists the nodes to compare, all by default."""
    nodes = fixed or body.nodes
    u, at = solution.u(nodes), solution.at(nodes)
    dim = solution.model.dim
    field = {i: [sum(gradient[r][c] * at[i][c] for c in range(dim)) for r in range(dim)] for i in nodes}
    shift = [sum(u[i][d] - field[i][d] for i in nodes) / len(nodes) for d in range(dim)]
    mean = [sum(field[i][d] for i in nodes) / len(nodes) for d in range(dim)]
    scale = max(abs(field[i][d] - mean[d]) for i in nodes for d in range(dim))
    return max(abs(u[i][d] - field[i][d] - shift[d]) for i in nodes for d in range(dim)) / scale


def displacement_error(solution, nodes, exact):
    """Largest departure from a field `exact`(X) over the field's largest value."""
    u, at = solution.u(nodes), solution.at(nodes)
    dim = solution.model.dim
    field = {i: exact(at[i]) for i in nodes}
    scale = max(abs(field[i][d]) for i in nodes for d in range(dim))
    return max(abs(u[i][d] - field[i][d]) for i in nodes for d in range(dim)) / scale


def plane_strain(young, poisson, sxx, syy, sxy=0.0):
    """The displacement gradient of a uniform stress in plane strain, without rotation."""
    a, b = (1 - poisson ** 2) / young, -poisson * (1 + poisson) / young
    shear = (1 + poisson) / young * sxy
    return [[a * sxx + b * syy, shear], [shear, a * syy + b * sxx]]


def solid(young, poisson, *stress):
    """The displacement gradient of three uniform normal stresses."""
    trace = sum(stress)
    return [[((1 + poisson) * stress[r] - poisson * trace) / young if r == c else 0.0 for c in range(3)] for r in range(3)]


def mean(values):
    values = list(values)
    return sum(values) / len(values)


def spread(values):
    """Largest departure from the mean, over the mean; infinite where all is zero."""
    values = list(values)
    m = mean(values)
    return max(abs(v - m) for v in values) / abs(m) if m else math.inf


def rms(values):
    values = list(values)
    return math.sqrt(mean(v * v for v in values))


def lame(rings, inner, outer):
    """Radial displacement u = A r + B/r of nested rings [(r0, r1, E, ν)] in plane strain that bear on each other.

    `inner` and `outer` are ("pressure", p) or ("displacement", u). An interference is a third entry of `rings`' tuples beyond ν.
    Returns the list of (A, B) and the function for the radial stress."""
    count = 2 * len(rings)
    rows, right = [], []

    def stress(k, r):
        young, poisson = rings[k][2], rings[k][3]
        lam, mu = young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson))
        return {2 * k: 2 * (lam + mu), 2 * k + 1: -2 * mu / r ** 2}

    def moved(k, r):
        return {2 * k: r, 2 * k + 1: 1.0 / r}
    for (kind, value), k, r in ((inner, 0, rings[0][0]), (outer, len(rings) - 1, rings[-1][1])):
        rows.append(stress(k, r) if kind == "pressure" else moved(k, r))
        right.append(-value if kind == "pressure" else value)
    for k in range(len(rings) - 1):
        r, gap = rings[k][1], (rings[k][4] if len(rings[k]) > 4 else 0.0)
        rows.append({**stress(k, r), **{c: -v for c, v in stress(k + 1, r).items()}})
        right.append(0.0)
        rows.append({**moved(k + 1, r), **{c: -v for c, v in moved(k, r).items()}})
        right.append(gap)
    x = gauss([[row.get(c, 0.0) for c in range(count)] for row in rows], right)
    pairs = [(x[2 * k], x[2 * k + 1]) for k in range(len(rings))]
    return pairs, lambda k, r: sum(c * x[i] for i, c in stress(k, r).items())


def gauss(a, b):
    """Solves a small system by elimination with pivoting."""
    n, a, b = len(b), [row[:] for row in a], list(b)
    for k in range(n):
        p = max(range(k, n), key=lambda i: abs(a[i][k]))
        a[k], a[p], b[k], b[p] = a[p], a[k], b[p], b[k]
        for i in range(k + 1, n):
            f = a[i][k] / a[k][k]
            b[i] -= f * b[k]
            for j in range(k, n):
                a[i][j] -= f * a[k][j]
    for k in reversed(range(n)):
        b[k] = (b[k] - sum(a[k][j] * b[j] for j in range(k + 1, n))) / a[k][k]
    return b
