"""Double cantilever beam of two arms that a cohesive zone joins; the crack grows."""
from lib.case import Case, Quantity
from lib.specimen import Specimen

SPECIMEN = Specimen("cantilevers", 80.0, 30.0, 3.5, 40)


def run(n, **units):
    return SPECIMEN.run(n, (35.0, 50.0), **units)


CASE = Case(
    "Double cantilever beam", "linear fracture mechanics of beams: G = 12 F² a²/(E h³)", "ANALYTIC",
    "The theory neglects shear of the arms and the length of the zone of softening; the rotation at the tip of the crack lengthens it (3 %).",
    [Quantity("force over beam theory", 1.0, 0.03, order=False), Quantity("largest deviation", 0.0, 0.03, scale=1.0, order=False)],
    (1,), run, variants={"": {}, "millimetres": {"length": 1e3, "stress": 1e-6}}, quick=False,
    note="The crack opens in mode I.")
