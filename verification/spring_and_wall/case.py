"""Springs kept by walls: the worked examples of the specification, by each method."""
from lib.case import Case, Outcome, Quantity
from lib.decks import run_deck

DECKS = {  # table: folder, position and multiplier at the end, solves
    "D.2, penalty": ("linear_spring/table_d2", -2e-6, None, 2), "D.3, multiplier": ("linear_spring/table_d3", 0.0, -2.0, 1),
    "D.4, multiplier": ("quartic_spring/table_d4", 1.0, 1.0, 3), "D.5, multiplier": ("quartic_spring/table_d5", 1.0, 1.0, 3),
    "D.6, multiplier": ("quartic_spring/table_d6", 1.0, 1.0, 3), "D.7, penalty": ("moved_wall/table_d7", -0.9, None, 8),
    "D.8, multiplier": ("moved_wall/table_d8", -0.9, -0.001, 8), "D.10, multiplier": ("moved_wall/table_d10", -0.9, -0.001, 8),
    "D.11, augmented, ε = 0.5": ("moved_wall/table_d11", -0.9, -0.001, 8), "D.12, augmented, ε = 1": ("moved_wall/table_d12", -0.9, -0.001, 8),
    "D.13, augmented, ε = 5": ("moved_wall/table_d13", -0.9, -0.001, 8), "D.14, augmented, ε = 10": ("moved_wall/table_d14", -0.9, -0.001, 8)}


def run(mesh, deck):
    name = DECKS[deck][0]
    report, last = run_deck(f"spring_and_wall/{name}.json", results=name.split("/")[1].replace("table_", "iterates_") + ".json")
    values = dict(zip(last["columns"], last["iterates"][-1]["values"]))
    out = {"position": values.get("x", values.get("u")), "solves": report.iterations}
    if "lambda" in values:
        out["multiplier"] = values["lambda"]
    return Outcome(report, out)


CASE = Case(
    "Springs and walls", "the worked examples of the specification, Tables D.2 to D.14 (examples/spring_and_wall)", "EXTERNAL",
    "The tables print the last iterates and count the solves; positions and multipliers agree to their digits.",
    [Quantity("position", lambda v: DECKS[v["deck"]][1], 1e-5, scale=1.0, order=False),
     Quantity("multiplier", lambda v: DECKS[v["deck"]][2], 1e-9, scale=1.0, order=False), Quantity("solves", lambda v: DECKS[v["deck"]][3], 0.0, order=False)],
    (1,), run, variants={name: {"deck": name} for name in DECKS}, size=lambda n: 1.0)
