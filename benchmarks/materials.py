"""Sets of measured materials, on which the pages measure methods.

A further set is a line of `FURTHER`. `uplift.lab.runner` measures methods at the tasks
that `task` and `split_tasks` make of a set.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

import uplift
from benchmarks import ATLAS_FILES, ATLASES, ROOT
from uplift.atlas.atlas import Atlas, Entry
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.sensor import in_unit_cube
from uplift.common.arrays import Array, Indices
from uplift.lab.look_alikes import families_like
from uplift.lab.runner import Task, divided, spectra_of
from uplift.lookup.cube import Cube

FURTHER = {"munsell": ROOT / "out" / "munsell.csv"}
"""Files of large sets that cannot be redistributed: the 1,269 chips of the Munsell
book, if `make munsell` has fetched them.
"""
FETCHED = tuple(name for name, file in FURTHER.items() if file.exists())
LARGE = ("rawtoaces", "cie2017", *FETCHED)
"""Atlases that are large enough to split."""
SHIPPED = ("macbeth", "babelcolor", "pmc", "rawtoaces", "cie2017", "tcs", "vs")
MIXTURE = "all sets"
"""The shipped sets, and all of them as one: a mixture of families, several of which
have materials of one colour.
"""
DERIVED = {"munsell": ("otsu2018",)}
"""Families derived from a set: the clusters of Otsu et al. were learnt from this book.
"""
SENSOR = observer.sensor()
SPLITS = 3
VISIBLE = 1.0
"""ΔE00 that is just visible."""


@dataclass(frozen=True, eq=False)
class Materials:
    """Reflectances (E, 81) and linear sRGB (E, 3) of entries inside sRGB."""

    measured: Array
    rgb: Array

    def take(self, rows: Indices) -> "Materials":
        """Select some of the entries."""
        return Materials(self.measured[rows], self.rgb[rows])

    @property
    def atlas(self) -> Atlas:
        """Return the entries as an atlas."""
        entries = (
            Entry(str(row), SENSOR.wavelengths, values)
            for row, values in enumerate(self.measured)
        )
        return Atlas(tuple(entries))


def inside(atlas: Atlas) -> Materials:
    """Return the entries of an atlas that are inside sRGB."""
    measured = spectra_of(atlas, SENSOR)
    rgb = SENSOR.rgb(measured)
    rows = in_unit_cube(rgb)
    return Materials(measured[rows], np.clip(rgb[rows], 0, 1))


def read_atlases() -> dict[str, Atlas]:
    """Read all atlases of the repository, by name."""
    return {path.stem: read_atlas(path) for path in ATLAS_FILES}


@cache
def spectra(name: str) -> Atlas:
    """Read a set of measured spectra."""
    names = SHIPPED if name == MIXTURE else [name]
    files = [FURTHER.get(member, ATLASES / f"{member}.txt") for member in names]
    return read_atlas(*files)


@cache
def materials(name: str) -> Materials:
    """Return the materials of a set, without duplicate colours."""
    entries = inside(spectra(name))
    _, first = np.unique(np.round(entries.rgb, 6), axis=0, return_index=True)
    return entries.take(np.sort(first))


@cache
def shipped_families(name: str) -> tuple[str, ...]:
    """Return the shipped families that a prior tested on a set must not know: those
    that have its spectra, look-alikes of many, or were derived from it.
    """
    return (*families_like(materials(name).measured), *DERIVED.get(name, ()))


def task(queried: str, known: Atlas | None = None) -> Task:
    """Query a whole set, whose families are not known, next to a known atlas."""
    measured = materials(queried).measured
    return Task(SENSOR, known or Atlas(), measured, shipped_families(queried))


def split_tasks(name: str, parts: int = 2) -> list[Task]:
    """Query each part of a set, divided at random, where the others are known."""
    left_out = shipped_families(name)
    return list(divided(materials(name).atlas, left_out, SENSOR, parts, SPLITS))


def other_halves(name: str, **options: Any) -> Iterator[tuple[Cube, Task]]:
    """Yield cubes of random halves of a set, and the tasks of the other halves: every
    material is queried equally often.
    """
    for task in split_tasks(name):
        yield uplift.build(task.known, leave_out=task.left_out, **options), task
