"""End-notched flexure: two arms that a cohesive zone joins, bent in three points; the crack slides, its lips in contact."""
from lib.specimen import Specimen

CASE = Specimen("flexure", 200.0, 75.0, 9.0, 30).case(
    "End-notched flexure", "G = 9 F² a²/(16 E h³)", "The theory neglects shear of the arms and the length of the zone of softening (3 %).",
    (84.0, 97.0), "The crack slides in mode II.")
