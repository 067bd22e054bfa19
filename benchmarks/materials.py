"""Measured materials that cubes are tested on, and the errors of answers for them."""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

import uplift
from benchmarks import ATLAS_FILES, ATLASES, ROOT, Row
from uplift.atlas import Atlas, Entry, read_atlas, resample
from uplift.colorimetry import in_unit_cube, observer
from uplift.common.arrays import Array, Indices
from uplift.extras.colour.light_sets import HELD_OUT_LIGHTS
from uplift.lab.study.held_out import halves_both_ways, spectrum_errors
from uplift.lab.study.look_alikes import families_like
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
DERIVED = {"munsell": ("otsu2018",)}
"""Families derived from a set: the clusters of Otsu et al. were learnt from this book.
"""
SENSOR = observer.sensor()
SPLITS = 3


@dataclass(frozen=True, eq=False)
class Materials:
    """Reflectances (E, 81) and linear sRGB (E, 3) of entries inside sRGB."""

    measured: Array
    rgb: Array

    def take(self, rows: Indices) -> "Materials":
        """Select some of the entries."""
        return Materials(self.measured[rows], self.rgb[rows])

    def cube(self, **options: Any) -> Cube:
        """Build a cube whose atlas they are."""
        entries = (
            Entry(str(row), SENSOR.wavelengths, values)
            for row, values in enumerate(self.measured)
        )
        return uplift.build(Atlas(tuple(entries)), **options)


def inside(atlas: Atlas) -> Materials:
    """Return the entries of an atlas that are inside sRGB."""
    measured = resample(atlas, SENSOR.wavelengths).values
    rgb = SENSOR.rgb(measured)
    rows = in_unit_cube(rgb)
    return Materials(measured[rows], np.clip(rgb[rows], 0, 1))


def read_atlases() -> dict[str, Atlas]:
    """Read all atlases of the repository, by name."""
    return {path.stem: read_atlas(path) for path in ATLAS_FILES}


@cache
def spectra(name: str) -> Atlas:
    """Read a set of measured spectra, or all shipped sets."""
    if name == MIXTURE:
        return read_atlas(*(ATLASES / f"{member}.txt" for member in SHIPPED))
    return read_atlas(MUNSELL if name == "munsell" else ATLASES / f"{name}.txt")


@cache
def materials(name: str) -> Materials:
    """Return the materials of a set, without duplicate colours."""
    entries = inside(spectra(name))
    _, first = np.unique(np.round(entries.rgb, 6), axis=0, return_index=True)
    return entries.take(np.sort(first))


def shipped_families(name: str) -> tuple[str, ...]:
    """Return the shipped families that a prior tested on a set must not know: those
    that have its spectra, look-alikes of many, or were derived from it.
    """
    return (*families_like(materials(name).measured), *DERIVED.get(name, ()))


def other_halves(name: str, **options: Any) -> list[tuple[Cube, Materials]]:
    """Return cubes of random halves of a set, and the other halves: every material is
    queried equally often.
    """
    whole = materials(name)
    left_out = shipped_families(name)
    return [
        (whole.take(kept).cube(leave_out=left_out, **options), whole.take(queried))
        for kept, queried in halves_both_ways(np.arange(len(whole.rgb)), SPLITS)
    ]


def errors(answers: Array, queried: Materials) -> Row:
    """Return the mean rms and the mean ΔE00 under each light."""
    return as_record(spectrum_errors(answers, queried.measured).means())


def as_record(means: Array) -> Row:
    """Convert mean rms and mean ΔE00, as of `spectrum_errors`, to names."""
    return {"rms": means[0], "errors": by_light(means[1:])}


def by_light(values: Array) -> Row:
    """Name values for each of `HELD_OUT_LIGHTS`."""
    return dict(zip(HELD_OUT_LIGHTS, values, strict=True))
