"""Atlases of the study: those used for design choices, and those used only for testing."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

import uplift
import uplift.pipeline.options
from benchmarks.record import ROOT
from uplift.atlas import Atlas, read_atlas, resample
from uplift.colorimetry import observer
from uplift.colorimetry.lights import HELD_OUT_LIGHTS
from uplift.common.arrays import Array
from uplift.fit.entries import BALANCED, FittedEntries, Weights, fit_entries
from uplift.fit.problem import Problem
from uplift.lab.study.held_out import spectrum_errors
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap, forward_map

CHOSEN_ON = ("rawtoaces", "babelcolor", "pmc", "tcs", "vs")
"""Atlases used for design choices."""
TESTED_ON = ("macbeth", "cie2017")
MUNSELL = ROOT / "out" / "munsell.csv"
"""The 1,269 chips of the Munsell book, if `make munsell` has fetched them: they cannot be redistributed."""
SENSOR = observer.sensor()


@dataclass(frozen=True, eq=False)
class Materials:
    """Reflectances (E, 81) and linear sRGB (E, 3) of the entries inside sRGB, without duplicate colours."""

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
    """Return the atlases that are large enough to split."""
    return ("rawtoaces", "cie2017", *(["munsell"] if MUNSELL.exists() else []))


@cache
def forward(model: Model) -> ForwardMap:
    return forward_map(model, SENSOR.wavelengths, SENSOR.matrix)


def entries(
    model: Model,
    some: Materials,
    lights: Sequence[str] = uplift.pipeline.options.Options.lights,
    weights: Weights = BALANCED,
) -> FittedEntries:
    return fit_entries(problem_of(model, lights), some.measured, some.rgb, weights)


def problem_of(model: Model, lights: Sequence[str] = uplift.pipeline.options.Options.lights) -> Problem:
    """Return the problem of a build under some lights, with errors under the second of them."""
    illuminants = tuple(observer.light(name) for name in lights)
    return Problem(SENSOR, model, illuminants, illuminants[1])


def spectra_of(model: Model, multipliers: Array) -> Array:
    return np.asarray(model.squash(multipliers @ forward(model).basis.T))


def errors(spectra: Array, some: Materials) -> dict[str, Any]:
    """Return the mean rms and the mean ΔE00 under each light."""
    return as_record(spectrum_errors(spectra, some.measured).means())


def as_record(means: Array) -> dict[str, Any]:
    """Convert the order of `spectrum_errors` to names."""
    rms, *delta_e = np.asarray(means).tolist()
    return {"rms": rms, "errors": dict(zip(HELD_OUT_LIGHTS, delta_e, strict=True))}
