"""Spectra of cubes and of other methods compared with measured spectra, for
docs/materials.md, docs/prior.md and docs/accuracy.md.

All answers are rows of `uplift.lab.runner`. No method knows the families of the set
that it is queried for.
"""

from collections.abc import Iterator

from benchmarks import Row
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
POOLED = "all shipped"
"""Set of the errors of all shipped sets, each without its family."""
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
    f"{NO_ATLAS}, smooth prior": cube(dim=DIM, prior="smooth"),
    SIGMOID: cube(dim=DIM, model="sigmoid"),
    **LIBRARY_METHODS,
    **{method.title: method.prepare for method in PUBLISHED},
}
"""Methods that know no atlas."""


def halves() -> Iterator[Row]:
    """Query methods with half of a set as the atlas for the other half."""
    for name in SPLIT:
        yield from measure(WITH_ATLAS, split_tasks(name), LIGHTS, set=name)


def parts() -> Iterator[Row]:
    """Query methods that know more of the mixture for the others."""
    for count in PARTS:
        tasks = split_tasks(MIXTURE, count)
        known = 1 - 1 / count
        yield from measure(WITH_ATLAS, tasks, LIGHTS, set=MIXTURE, known=known)


def alone() -> Iterator[Row]:
    """Query methods without an atlas for whole sets, and pool the shipped ones."""
    lights = list(LIGHTS.values())
    for method, prepare in ALONE.items():
        errors = {
            name: pooled_errors(prepare, [task(name)], lights)
            for name in (*SHIPPED, *FETCHED, MIXTURE)
        }
        errors[POOLED] = join([errors[name] for name in SHIPPED])
        for name, of_set in errors.items():
            yield from of_set.rows(LIGHTS, method=method, set=name)


def of_chart() -> Iterator[Row]:
    """Query a cube of the ColorChecker for its patches, and for materials of others."""
    cubes = {HALF: WITH_ATLAS[HALF]}
    for name in (CHART, *LARGE):
        yield from measure(cubes, [task(name, spectra(CHART))], LIGHTS, set=name)


def left_out() -> list[Row]:
    """Return the families that no method knows, by set."""
    sets = (*SHIPPED, *FETCHED)
    return [{"set": name, "families": shipped_families(name)} for name in sets]


QUESTIONS = {
    "halves": halves,
    "parts": parts,
    "alone": alone,
    "of_chart": of_chart,
    "left_out": left_out,
}
