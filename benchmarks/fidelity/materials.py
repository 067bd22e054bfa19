"""Atlases for the study: what choices are made on, and what they are judged on."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

import uplift
from benchmarks.timing import ROOT
from uplift import fit
from uplift.atlas import Atlas, read_atlas, resample
from uplift.colorimetry import observer
from uplift.colorimetry.lights import HELD_OUT_LIGHTS
from uplift.common.arrays import Array
from uplift.lab.study.held_out import spectrum_errors
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap, forward_map

CHOSEN_ON = ("rawtoaces", "babelcolor", "pmc", "tcs", "vs")
"""Atlases that choices are made on."""
JUDGED_ON = ("macbeth", "cie2017")
MUNSELL = ROOT / "out" / "munsell.csv"
"""The 1,269 chips of the Munsell book, if `make munsell` has brought them: they are not ours to pass on."""
SENSOR = observer.sensor()


@dataclass(frozen=True, eq=False)
class Materials:
    """Reflectances (E, 81) and linear sRGB (E, 3) of the entries that sRGB holds, no colour twice."""

    name: str
    measured: Array
    rgb: Array

    def take(self, rows: Sequence[int] | Array) -> Materials:
        return Materials(self.name, self.measured[rows], self.rgb[rows])


@cache
def spectra(name: str) -> Atlas:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        return read_atlas(MUNSELL if name == "munsell" else ROOT / "atlases" / f"{name}.txt")


@cache
def materials(name: str) -> Materials:
    measured = resample(spectra(name), SENSOR.wavelengths).values
    rgb = SENSOR.rgb(measured)
    _, first = np.unique(np.round(rgb, 6), axis=0, return_index=True)
    rows = [row for row in sorted(first) if SENSOR.contains(rgb[row])]
    return Materials(name, measured[rows], np.clip(rgb[rows], 0, 1))


def large() -> tuple[str, ...]:
    """Atlases that are worth halving."""
    return ("rawtoaces", "cie2017", *(["munsell"] if MUNSELL.exists() else []))


@cache
def ahead(model: Model) -> ForwardMap:
    return forward_map(model, SENSOR.wavelengths, SENSOR.matrix)


def entries(
    model: Model,
    some: Materials,
    lights: Sequence[str] = uplift.pipeline.options.Options.lights,
    weights: fit.Weights = fit.objective.BALANCED,
) -> fit.FittedEntries:
    shine = [observer.light(name) for name in lights]
    return fit.fit_entries(model, ahead(model), some.measured, some.rgb, shine, shine[1], 1e-6, weights)


def spectra_of(model: Model, multipliers: Array) -> Array:
    return np.asarray(model.squash(multipliers @ ahead(model).basis.T))


def row(name: str, answered: Array, some: Materials, digits: int = 3) -> list[str]:
    """Name, mean rms and mean ΔE00 under each light, as cells."""
    rms, *delta_e = spectrum_errors(answered, some.measured).means()
    return [name, f"{rms:.4f}", *(f"{value:.{digits}f}" for value in delta_e)]


HEAD = ["rms", *HELD_OUT_LIGHTS]
