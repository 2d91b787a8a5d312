# SPDX-License-Identifier: Apache-2.0
"""uav: windows of bearings with misses and false ones told apart."""

from figure_topics.figure import Figure, Section
from figure_topics.uav.batch import experiment, word

RUNS = 1000
# Cell, least Pr_m, its goal: those of the acceptance lines; the others are printed.
BOUNDED = {"m 5": (0.99, None), "m 10": (0.99, None), "m 2, Pd 0.8, 3 false": (0.98, 0.985)}
SWEEPS = ("m 1", "m 2", "m 20", "Pd 0.7", "Pd 0.8", "Pd 0.95", "Pd 1", "0 false", "3 false", "5 false",
          "no delays", "delays .3/.4", "rotating receivers", "cued receivers", "2 receivers", "4 receivers",
          "6 receivers")


def measure(bench):
    result = experiment(bench, "window", RUNS)
    for cell in (*BOUNDED, *SWEEPS):
        yield f"window/{word(cell)}/all-found", result[cell]["all_found"]
        yield f"window/{word(cell)}/oracle-all-found", result[cell]["oracle_all_found"]
        yield f"window/{word(cell)}/right-number", result[cell]["right_number"]
        yield f"window/{word(cell)}/false-per-run", result[cell]["false_per_run"]


def figures(cell):
    least, goal = BOUNDED.get(cell, (None, None))
    is_one_of_many = cell in ("m 5", "m 10")
    return [Figure(f"window/{word(cell)}/all-found", at_least=least, goal=goal),
            Figure(f"window/{word(cell)}/oracle-all-found"),
            Figure(f"window/{word(cell)}/right-number", at_least=0.98 if is_one_of_many else None),
            Figure(f"window/{word(cell)}/false-per-run", at_most=0.01 if is_one_of_many else None)]


SECTIONS = [Section("window", [figure for cell in (*BOUNDED, *SWEEPS) for figure in figures(cell)], measure)]
