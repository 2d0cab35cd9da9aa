"""End-notched flexure: two arms that a cohesive zone joins, bent in three points; the crack slides, its lips in contact."""
from lib.case import Case, Quantity
from lib.specimen import Specimen

SPECIMEN = Specimen("flexure", 200.0, 75.0, 9.0, 30)


def run(n, **units):
    return SPECIMEN.run(n, (84.0, 97.0), **units)


CASE = Case(
    "End-notched flexure", "linear fracture mechanics of beams: G = 9 F² a²/(16 E h³)", "ANALYTIC",
    "The theory neglects shear of the arms and the length of the zone of softening (3 %).",
    [Quantity("force over beam theory", 1.0, 0.03, order=False), Quantity("largest deviation", 0.0, 0.03, scale=1.0, order=False)],
    (1,), run, variants={"": {}, "millimetres": {"length": 1e3, "stress": 1e-6}}, quick=False,
    note="The crack slides in mode II.")
