"""Sets of measured materials, on which the pages measure methods.

A set is a line of `FILES`. `uplift.lab.runner` measures methods at the tasks that
`task` and `split_tasks` make of a set.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

import uplift
from benchmarks import ATLAS_FILES, ATLASES, ROOT, Row
from uplift.atlas import Atlas, Entry, read_atlas
from uplift.colorimetry import in_unit_cube, observer
from uplift.common.arrays import Array, Indices
from uplift.extras.colour.light_sets import HELD_OUT_LIGHTS
from uplift.lab.look_alikes import families_like
from uplift.lab.runner import (
    Task,
    divided,
    folds,
    named_lights,
    spectra_of,
    spectrum_errors,
)
from uplift.lookup import Cube

MUNSELL = ROOT / "out" / "munsell.csv"
"""The 1,269 chips of the Munsell book, if `make munsell` has fetched them: they cannot
be redistributed.
"""
FETCHED = ("munsell",) if MUNSELL.exists() else ()
LARGE = ("rawtoaces", "cie2017", *FETCHED)
"""Atlases that are large enough to split."""
SHIPPED = ("macbeth", "babelcolor", "pmc", "rawtoaces", "cie2017", "tcs", "vs")
MIXTURE = "all sets"
"""The shipped sets, and all of them as one: a mixture of families, several of which
have materials of one colour.
"""
FILES = {name: (ATLASES / f"{name}.txt",) for name in SHIPPED}
FILES |= {MIXTURE: tuple(ATLASES / f"{name}.txt" for name in SHIPPED)}
FILES |= {"munsell": (MUNSELL,)}
"""Files of each set."""
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

    def cube(self, **options: Any) -> Cube:
        """Build a cube whose atlas they are."""
        return uplift.build(self.atlas, **options)


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
    return read_atlas(*FILES[name])


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


def other_halves(name: str, **options: Any) -> list[tuple[Cube, Materials]]:
    """Return cubes of random halves of a set, and the other halves: every material is
    queried equally often.
    """
    entries = materials(name)
    left_out = shipped_families(name)
    return [
        (entries.take(known).cube(leave_out=left_out, **options), entries.take(queried))
        for known, queried in folds(len(entries.rgb), seeds=SPLITS)
    ]


def errors(answers: Array, queried: Materials) -> Row:
    """Return the mean rms and the mean ΔE00 under each light."""
    lights = list(named_lights().values())
    compared = spectrum_errors(answers, queried.measured, lights)
    return {"rms": compared.rms.mean(), "errors": by_light(compared.delta_e.mean(0))}


def by_light(values: Array) -> Row:
    """Name values for each of `HELD_OUT_LIGHTS`."""
    return dict(zip(HELD_OUT_LIGHTS, values, strict=True))
