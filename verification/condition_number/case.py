"""Condition of the system over scale factor and penalty: a punch on a block."""
import math

from lib.case import Case, Outcome, Quantity
from lib.decks import run_deck

TABLE = {(1, 1e-12): 1.13e5, (1, 1): 1.13e5, (1, 10): 1.18e5, (1, 100): 1.63e5, (1, 1000): 6.15e5, (1, 10000): 2.69e7,
         (10, 1): 1.74e4, (100, 1e-12): 1.74e4, (100, 100): 1.74e4, (100, 10000): 9.38e4, (1000, 1e-12): 6.60e4, (10000, 1): 6.63e5}


def run(mesh, k, eps):
    def change(deck):
        deck["processes"]["contact_process_list"][0]["Parameters"]["advance_ALM_parameters"].update(manual_ALM=True, scale_factor=float(k), penalty=eps)
        deck.pop("output_processes", None)
    report, _ = run_deck("condition_number/ProjectParameters.json", change)
    return Outcome(report, {"log₁₀ κ": math.log10(report.steps[-1]["iterations"][-1]["condition_number"])})


CASE = Case(
    "Condition number over scale factor and penalty", "Table 4.2 of the specification (V. Mataix, thesis, 2020)", "EXTERNAL",
    "The mesh of the table is not printed, and κ depends on it and on the scaling of the matrix; a factor of two is allowed.",
    [Quantity("log₁₀ κ", lambda v: math.log10(TABLE[v["k"], v["eps"]]), 0.3, scale=1.0, order=False)],
    (1,), run, variants={f"k = {k:g}, ε = {eps:g}": {"k": k, "eps": eps} for k, eps in TABLE}, size=lambda n: 1.0, quick=False)
