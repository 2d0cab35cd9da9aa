"""Condition of the system over scale factor and penalty: a punch on a block."""
import math

from lib.case import Case, Outcome, Quantity
from lib.decks import run_deck

PENALTIES = (1e-12, 1e-2, 1, 10, 100, 1000, 10000)
ROWS = {1: (1.13e5, 1.13e5, 1.13e5, 1.18e5, 1.63e5, 6.15e5, 2.69e7), 10: (1.74e4, 1.74e4, 1.74e4, 1.74e4, 1.74e4, 1.74e4, 2.69e5),
        100: (1.74e4, 1.74e4, 1.74e4, 1.74e4, 1.74e4, 1.74e4, 9.38e4), 1000: (6.60e4, 6.60e4, 5.75e5, 1.92e4, 1.81e4, 3.14e4, 6.43e4),
        10000: (6.64e5, 6.63e5, 6.63e5, 6.63e5, 3.53e5, 3.26e6, 7.38e5)}
BROKEN = {(1000, 1), (1000, 10), (1000, 100), (1000, 1000), (1000, 10000), (10000, 100), (10000, 1000)}
TABLE = {(k, eps): kappa for k, row in ROWS.items() for eps, kappa in zip(PENALTIES, row)}


def name(k, eps):
    return f"k = {k:g}, ε = {eps:g}"


def run(mesh, k, eps):
    def change(deck):
        deck["processes"]["contact_process_list"][0]["Parameters"]["advance_ALM_parameters"].update(manual_ALM=True, scale_factor=float(k), penalty=eps)
        deck.pop("output_processes", None)
    report, _ = run_deck("condition_number/ProjectParameters.json", change)
    return Outcome(report, {"log₁₀ κ": math.log10(report.steps[-1]["iterations"][-1]["condition_number"])})


CASE = Case(
    "Condition number over scale factor and penalty", "Table 4.2 of the specification (V. Mataix, thesis, 2020)", "EXTERNAL",
    "The mesh of the table is not printed, and κ depends on it and on the scaling of the matrix; a factor of two is allowed. "
    "Printed numbers of the rows k = 1000 and 10000 that miss break bounds of every mesh (examples/condition_number/README.md).",
    [Quantity("log₁₀ κ", lambda v: math.log10(TABLE[v["k"], v["eps"]]), 0.3, scale=1.0, order=False)],
    (1,), run, variants={name(k, eps): {"k": k, "eps": eps} for k, eps in TABLE}, size=lambda n: 1.0, quick=False,
    known={name(*one): "the printed number breaks a bound of every mesh" for one in BROKEN})
