"""Pictures of the atlas as SVG text: deformed meshes, curves beside published ones, convergence."""
import math

WIDTH, HEIGHT, PAD = 300, 220, 38
COLOURS = ["#1f5fa8", "#c0392b", "#2e8b57", "#8e44ad", "#d98200", "#555555"]


def text(x, y, words, anchor="middle", size=11):
    words = str(words).replace("&", "&amp;").replace("<", "&lt;")
    return f'<text x="{x:.0f}" y="{y:.0f}" text-anchor="{anchor}" font-size="{size}">{words}</text>'


def page(panels):
    """Panels side by side."""
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH * len(panels)} {HEIGHT}" width="{WIDTH * len(panels)}" '
           f'font-family="sans-serif"><rect width="100%" height="100%" fill="white"/>']
    for k, panel in enumerate(panels):
        out.append(f'<g transform="translate({WIDTH * k},0)">{panel}</g>')
    return "\n".join(out) + "\n</svg>\n"


class Axes:
    """A frame that maps data to the panel, linear or logarithmic."""

    def __init__(self, points, logarithmic=False):
        self.log = logarithmic
        xs, ys = [self._of(p[0]) for p in points], [self._of(p[1]) for p in points]
        self.low, self.high = [min(xs), min(ys)], [max(xs), max(ys)]
        for d in (0, 1):
            wide = self.high[d] - self.low[d] or abs(self.high[d]) or 1.0
            self.low[d] -= 0.05 * wide
            self.high[d] += 0.05 * wide

    def _of(self, v):
        return math.log10(v) if self.log else v

    def at(self, x, y):
        u = (self._of(x) - self.low[0]) / (self.high[0] - self.low[0])
        v = (self._of(y) - self.low[1]) / (self.high[1] - self.low[1])
        return PAD + 12 + u * (WIDTH - PAD - 24), HEIGHT - PAD - v * (HEIGHT - PAD - 30)

    def frame(self, title, xlabel):
        ends = [10 ** v if self.log else v for v in (self.low[0], self.high[0], self.low[1], self.high[1])]
        say = lambda v: f"{v:.2g}"
        left, right, bottom, top = PAD + 12, WIDTH - 12, HEIGHT - PAD, 30
        return "".join([f'<rect x="{left}" y="{top}" width="{right - left}" height="{bottom - top}" fill="none" stroke="#999"/>',
                        text((left + right) / 2, 18, title, size=12), text((left + right) / 2, HEIGHT - 8, xlabel),
                        text(left, bottom + 14, say(ends[0]), "start", 9), text(right, bottom + 14, say(ends[1]), "end", 9),
                        text(left - 3, bottom, say(ends[2]), "end", 9), text(left - 3, top + 8, say(ends[3]), "end", 9)])


def path(points, colour, width=1.2, dash=""):
    line = " ".join(f"{'M' if k == 0 else 'L'}{x:.1f} {y:.1f}" for k, (x, y) in enumerate(points))
    return f'<path d="{line}" fill="none" stroke="{colour}" stroke-width="{width}"{dash and f" stroke-dasharray={chr(34)}{dash}{chr(34)}"}/>'


def curves(given, title="computed (dots), published (line)", xlabel=""):
    """Published curves as lines, computed ones as dots."""
    axes = Axes([p for points in given.values() for p in points])
    out = [axes.frame(title, xlabel)]
    for name, points in given.items():
        drawn = [axes.at(*p) for p in points]
        if name.startswith("published"):
            out.append(path(drawn, COLOURS[5]))
            if len(points) < 8:
                out += [f'<rect x="{x - 2:.1f}" y="{y - 2:.1f}" width="4" height="4" fill="{COLOURS[5]}"/>' for x, y in drawn]
        else:
            out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="1.8" fill="{COLOURS[0]}"/>' for x, y in drawn]
    return "".join(out)


def convergence(series, title="error over mesh size"):
    """Errors over sizes by name, both logarithmic; a dashed line of slope one."""
    axes = Axes([p for points in series.values() for p in points], True)
    out = [axes.frame(title, "mesh size")]
    for k, (name, points) in enumerate(series.items()):
        colour = COLOURS[k % len(COLOURS)]
        drawn = [axes.at(*p) for p in points]
        out.append(path(drawn, colour))
        out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.2" fill="{colour}"/>' for x, y in drawn]
        out.append(text(PAD + 18, 44 + 12 * k, name, "start", 9).replace("<text", f'<text fill="{colour}"'))
    return "".join(out)


def mesh(model, solution, most=700):
    """The deformed mesh at the end of a run, displacements enlarged to be seen; boundary facets only in space."""
    everything = sorted({i for b in model.bodies for i in b.nodes})
    u, at = solution.u(everything), solution.at(everything)
    size = max(max(at[i][d] for i in everything) - min(at[i][d] for i in everything) for d in range(model.dim))
    largest = max(math.hypot(*u[i]) for i in everything) or 1.0
    factor = max(1.0, 10 ** math.floor(math.log10(0.08 * size / largest)))
    moved = {i: [at[i][d] + factor * u[i][d] for d in range(3)] for i in everything}
    if model.dim == 3:
        project = lambda p: (0.87 * (p[0] + 0.6 * p[1]), p[2] + 0.35 * p[1] - 0.18 * p[0])
        depth = lambda f: sum(0.5 * moved[i][0] - moved[i][1] + 0.4 * moved[i][2] for i in f) / len(f)
        faces = sorted((f for b in model.bodies for side in b.facets.values() for f in side), key=depth)
    else:
        project = lambda p: (p[0], p[1])
        faces = [cell[:4] if len(cell) != 3 else cell for b in model.bodies for cell in b.cells]
        if len(faces) > most:
            faces = [f for b in model.bodies for side in b.facets.values() for f in side]
    points = {i: project(p) for i, p in moved.items()}
    xs, ys = [p[0] for p in points.values()], [p[1] for p in points.values()]
    scale = min((WIDTH - 20) / (max(xs) - min(xs)), (HEIGHT - 40) / (max(ys) - min(ys)))
    place = lambda i: (WIDTH / 2 + scale * (points[i][0] - (max(xs) + min(xs)) / 2), HEIGHT / 2 + 8 - scale * (points[i][1] - (max(ys) + min(ys)) / 2))
    data = "".join("M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in map(place, face)) + "Z" for face in faces)
    fill = "#dfe9f5" if model.dim == 2 else "#eef3fa"
    if model.dim == 3:
        data_of = lambda face: "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in map(place, face)) + "Z"
        shapes = "".join(f'<path d="{data_of(face)}"/>' for face in faces[-most:])
        drawn = f'<g fill="{fill}" stroke="#335" stroke-width=".4">{shapes}</g>'
    else:
        drawn = f'<path d="{data}" fill="{fill}" stroke="#335" stroke-width=".4"/>'
    return drawn + text(WIDTH / 2, 16, f"displacements × {factor:g}" if factor != 1.0 else "displacements as they are", size=11)
