"""Double cantilever beam of two arms that a cohesive zone joins; the crack grows."""
from lib.specimen import Specimen

CASE = Specimen("cantilevers", 80.0, 30.0, 3.5, 40).case(
    "Double cantilever beam", "G = 12 F² a²/(E h³)",
    "The theory neglects shear of the arms and the length of the zone of softening; the rotation at the tip of the crack lengthens it (3 %).",
    (35.0, 50.0), "The crack opens in mode I.")
