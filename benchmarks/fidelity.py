"""Spectra of cubes and of other methods compared with measured spectra, for
docs/materials.md, docs/prior.md and docs/accuracy.md.

All answers are rows of `uplift.lab.runner`. No method knows the families of the set
that it is queried for.
"""

from itertools import chain

from benchmarks import Row
from benchmarks.choices import ALONE_SMOOTH, POOLED
from benchmarks.materials import (
    FETCHED,
    LARGE,
    MIXTURE,
    SHIPPED,
    shipped_families,
    spectra,
    split_tasks,
    task,
)
from uplift.fit import shipped_library
from uplift.lab.chart.selection import select_methods
from uplift.lab.methods import local_linear
from uplift.lab.methods.cubes import cube
from uplift.lab.runner import Prepare, join, measure, named_lights, pooled_errors
from uplift.lab.study.held_out import (
    HALF,
    LIBRARY_METHODS,
    LOCAL_LINEAR,
    NO_ATLAS,
    SIGMOID,
)

DIM = 32
CHART = "macbeth"
SPLIT = ("macbeth", "babelcolor", "pmc", "rawtoaces", "cie2017", *FETCHED, MIXTURE)
"""Sets of at least 20 entries; the others are too small to split."""
PARTS = (4, 10)
"""Parts of the mixture, of which methods know all but one."""
LIGHTS = named_lights()
WITH_ATLAS: dict[str, Prepare] = {
    HALF: cube(atlas=True, dim=DIM),
    LOCAL_LINEAR: local_linear.prepare,
}
PUBLISHED = select_methods(["otsu2018", "mallett2019", "smits1999"])
ALONE: dict[str, Prepare] = {
    NO_ATLAS: cube(dim=DIM),
    ALONE_SMOOTH: cube(dim=DIM, prior="smooth"),
    SIGMOID: cube(dim=DIM, model="sigmoid"),
    **LIBRARY_METHODS,
    **{method.title: method.prepare for method in PUBLISHED},
}
"""Methods that know no atlas."""


def halves() -> list[Row]:
    """Query methods with half of a set as the atlas for the other half."""
    rows = (measure(WITH_ATLAS, split_tasks(name), LIGHTS, set=name) for name in SPLIT)
    return list(chain.from_iterable(rows))


def parts() -> list[Row]:
    """Query methods that know more of the mixture for the others."""
    rows: list[Row] = []
    for count in PARTS:
        tasks = split_tasks(MIXTURE, count)
        known = 1 - 1 / count
        rows += measure(WITH_ATLAS, tasks, LIGHTS, set=MIXTURE, known=known)
    return rows


def alone() -> list[Row]:
    """Query methods without an atlas for whole sets, and pool the shipped ones."""
    rows: list[Row] = []
    lights = list(LIGHTS.values())
    for method, prepare in ALONE.items():
        errors = {
            name: pooled_errors(prepare, [task(name)], lights)
            for name in (*SHIPPED, *FETCHED, MIXTURE)
        }
        errors[POOLED] = join([errors[name] for name in SHIPPED])
        for name, each in errors.items():
            rows += each.rows(LIGHTS, method=method, set=name)
    return rows


def of_chart() -> list[Row]:
    """Query a cube of the ColorChecker for its patches, and for materials of others."""
    chart = spectra(CHART)
    cubes = {CHART: WITH_ATLAS[HALF]}
    rows: list[Row] = []
    for name in (CHART, *LARGE):
        rows += measure(cubes, [task(name, chart)], LIGHTS, set=name)
    return rows


def left_out() -> list[Row]:
    """Return the families that no method knows, by set."""
    sets = (*SHIPPED, *FETCHED)
    return [{"set": name, "families": shipped_families(name)} for name in sets]


def library() -> list[Row]:
    """Return the families of the shipped library and their sizes."""
    return [
        {"name": family.name, "spectra": len(family.measured)}
        for family in shipped_library()
    ]


QUESTIONS = {
    "halves": halves,
    "parts": parts,
    "alone": alone,
    "of_chart": of_chart,
    "left_out": left_out,
    "library": library,
}
