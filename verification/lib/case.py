"""Description of a case: quantities with their published values, meshes, variants."""


class Quantity:
    """A number a case computes, beside the published one.

    `tolerance` is relative to `published`, or to `scale` where that is given (errors about zero); a list has one entry a mesh, a
    dictionary one for each variant that has its own, and one at "" for the others. `published` may depend on the variant's settings;
    None then leaves the variant out. `tag` is that of the case unless it is given."""

    def __init__(self, name, published, tolerance, unit="", tag=None, scale=None, order=True):
        self.name, self.published, self.tolerance, self.unit, self.tag = name, published, tolerance, unit, tag
        self.scale, self.order = scale, order

    def error(self, computed, variant=None):
        published = self.published(variant) if callable(self.published) else self.published
        scale = self.scale if self.scale is not None else abs(published)
        return (computed - published) / scale

    def tolerance_of(self, level, variant=""):
        tolerance = self.tolerance
        if isinstance(tolerance, dict):
            tolerance = tolerance.get(variant, tolerance[""])
        if isinstance(tolerance, (list, tuple)):
            return tolerance[min(level, len(tolerance) - 1)]
        return tolerance


class Outcome:
    """Outcome of one run: values by quantity, and curves to draw."""

    def __init__(self, solution, values, curves=None, labels=None):
        self.values, self.curves, self.labels = values, curves, labels
        solutions = solution if isinstance(solution, (list, tuple)) else [solution]
        self.last = solutions[-1] if solutions else None
        self.iterations = sum(s.iterations for s in solutions if s)
        self.cuts = sum(s.cuts for s in solutions if s)
        self.warnings = sorted({w for s in solutions if s for w in s.warnings})


class Case:
    """A problem: `solve(mesh, **variant)` returns an Outcome for an entry of `meshes` (coarse to fine)."""

    def __init__(self, title, source, tag, why, quantities, meshes, solve, variants=None, note="", size=None, quick=True, known=None,
                 picture=None, slow=False):
        self.title, self.source, self.tag, self.why, self.note = title, source, tag, why, note
        self.quantities, self.meshes, self.solve = quantities, meshes, solve
        self.variants = variants or {"": {}}
        self.size = size or (lambda mesh: 1.0 / (mesh if isinstance(mesh, (int, float)) else mesh[0]))
        # whether the coarsest mesh of all variants (True), or of the named ones, is part of the test command
        self.quick = quick
        self.slow = slow  # begun first
        # the variant that is drawn: the first one unless another is named
        self.picture = picture or next(iter(self.variants))
        # why variants miss today, by name; "" for all
        self.known = known or {}
