"""Selection of wavelengths for docs/scene.md and its picture."""

from itertools import product

import numpy as np

import uplift
from benchmarks import ATLAS_FILES, DOCS, Row
from uplift.atlas import on_grid
from uplift.extras.scene.wavelengths import METHODS, grid, make_setup
from uplift.extras.scene.wavelengths.sampling import evaluate
from uplift.lab.statistics import statistics

OTHERS = ("meyer", "uniform", "bins")
"""Methods that are not fitted to materials."""
COUNTS = range(4, 17)
LIGHTS = (("A", "B", "C", "D65"), ("FL2", "FL7", "FL11"))
"""Smooth ones, and spiky ones."""


def errors() -> list[Row]:
    """Return ΔE00 of all methods and numbers of wavelengths under several lights at
    once, fitted to the even materials and tested on the odd ones.

    Methods that are not fitted get the latter, which favours Meyer's allocation.
    """
    materials = on_grid(uplift.read_atlas(*ATLAS_FILES), grid())
    is_odd = np.arange(len(materials)) % 2 == 1
    rows = []
    for lights in LIGHTS:
        setup = make_setup(materials, lights)
        fitted = setup.only(~is_odd)
        tested = setup.only(is_odd)
        for count, method in product(COUNTS, METHODS):
            known = tested if method in OTHERS else fitted
            found = evaluate(tested, METHODS[method](known, count))
            head = {"lights": ", ".join(lights), "method": method, "count": count}
            rows.append({**head, "n": found.size, **statistics(found)})
    return rows


QUESTIONS = {"errors": errors}
