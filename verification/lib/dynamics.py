"""Momentum and energy of planar bodies of quadrilaterals, total Lagrangian, with the law of Saint-Venant and Kirchhoff."""
import math

GAUSS = 1 / math.sqrt(3)
POINTS = [(-GAUSS, -GAUSS), (GAUSS, -GAUSS), (GAUSS, GAUSS), (-GAUSS, GAUSS)]
CORNERS = [(-1, -1), (1, -1), (1, 1), (-1, 1)]


class Balance:
    """Sums over bodies [(body, young, poisson, density)] in plane strain, of a unit of thickness."""

    def __init__(self, model, bodies):
        self.points = []
        for body, young, poisson, density in bodies:
            lam, mu = young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson))
            for cell in body.cells:
                at = [model.mesh.nodes[i] for i in cell]
                for xi, eta in POINTS:
                    shape = [(1 + a * xi) * (1 + b * eta) / 4 for a, b in CORNERS]
                    d = [(a * (1 + b * eta) / 4, b * (1 + a * xi) / 4) for a, b in CORNERS]
                    jac = [[sum(at[k][r] * d[k][c] for k in range(4)) for c in (0, 1)] for r in (0, 1)]
                    det = jac[0][0] * jac[1][1] - jac[0][1] * jac[1][0]
                    inv = [[jac[1][1] / det, -jac[0][1] / det], [-jac[1][0] / det, jac[0][0] / det]]
                    grad = [tuple(sum(d[k][c] * inv[c][r] for c in (0, 1)) for r in (0, 1)) for k in range(4)]
                    self.points.append((cell, shape, grad, det, lam, mu, density))
        self.nodes = sorted({i for p in self.points for i in p[0]})
        self.at = {i: model.mesh.nodes[i] for i in self.nodes}

    def of(self, solution, step):
        """(momentum x, y, angular momentum about the origin, kinetic energy, strain energy) at a step."""
        u, v = solution.u(self.nodes, step), solution.vector("VELOCITY", self.nodes, step)
        out = [0.0] * 5
        for cell, shape, grad, det, lam, mu, density in self.points:
            vel = [sum(n * v[i][d] for n, i in zip(shape, cell)) for d in (0, 1)]
            pos = [sum(n * (self.at[i][d] + u[i][d]) for n, i in zip(shape, cell)) for d in (0, 1)]
            f = [[(r == c) + sum(g[c] * u[i][r] for g, i in zip(grad, cell)) for c in (0, 1)] for r in (0, 1)]
            e = [[0.5 * (sum(f[k][r] * f[k][c] for k in (0, 1)) - (r == c)) for c in (0, 1)] for r in (0, 1)]
            mass, trace = density * det, e[0][0] + e[1][1]
            out[0] += mass * vel[0]
            out[1] += mass * vel[1]
            out[2] += mass * (pos[0] * vel[1] - pos[1] * vel[0])
            out[3] += 0.5 * mass * (vel[0] ** 2 + vel[1] ** 2)
            out[4] += det * (0.5 * lam * trace ** 2 + mu * sum(e[r][c] ** 2 for r in (0, 1) for c in (0, 1)))
        return out
