"""What the loss of the prior against the limit consists of: the limit turns into the prior step by step."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from benchmarks.fidelity.between import LIGHTS, SPLITS, krige_samples, limit_kernel, split
from benchmarks.fidelity.materials import SENSOR, Materials, entries, materials, problem_of
from benchmarks.fidelity.start import solved
from uplift.colorimetry.delta_e import rgb_to_lab
from uplift.colorimetry.lights import HELD_OUT_LIGHTS
from uplift.common.arrays import Array
from uplift.fit.base import Base, learn_base
from uplift.fit.entries import FittedEntries
from uplift.fit.families import Family, families_with, shipped_library
from uplift.fit.kriging import Kernel, krige
from uplift.fit.match_spectra import match_spectra
from uplift.fit.prior import Prior, fit_prior
from uplift.lab.study.held_out import spectrum_errors
from uplift.models import Moments

MIXED = ("rawtoaces", "cie2017")
MODEL = Moments(17)
PROBLEM = problem_of(MODEL)
DIMMEST = 2e-3
"""Least distance of kriged samples from 0 and 1 before coefficients represent them."""


def measure() -> dict[str, Any]:
    """Measure the steps on the splits of the holdout test."""
    return {"loss": [row for name in MIXED for row in steps(name)]}


def steps(name: str) -> Iterator[dict[str, Any]]:
    """Yield each step's mean ΔE00 relative to the limit: over all lights, and under each."""
    some, kernel = materials(name), Kernel(*limit_kernel(name))
    scores: dict[str, list[Array]] = {}
    for seed in range(SPLITS):
        kept, queried = (some.take(rows) for rows in split(some, seed))
        for label, spectra in _predictions(kept, queried, kernel):
            scores.setdefault(label, []).append(spectrum_errors(spectra, queried.measured).means()[1:])
    means = {label: np.mean(values, axis=0) for label, values in scores.items()}
    first, *_ = means.values()
    for label, mean in means.items():
        lights = dict(zip(HELD_OUT_LIGHTS, (mean / first).tolist(), strict=True))
        yield {"atlas": name, "step": label, "mean": float(mean.mean() / first.mean()), "errors": lights}


def _predictions(kept: Materials, queried: Materials, kernel: Kernel) -> Iterator[tuple[str, Array]]:
    """Yield spectra (n, 81) of the queried materials after each step."""
    samples = krige_samples(kept, queried, kernel.length, kernel.nugget)
    yield "limit: 81 samples", samples
    within = np.clip(samples, DIMMEST, 1 - DIMMEST)
    matched = match_spectra(MODEL, SENSOR.wavelengths, within, LIGHTS)
    yield "17 coefficients of them, exact colours", solved(MODEL, matched, queried.rgb)
    known = entries(MODEL, kept)
    smooth, _ = learn_base(PROBLEM)
    deviations = MODEL.to_storage(known.multipliers) - smooth.coefficients(kept.rgb)
    kriging, _ = krige(rgb_to_lab(SENSOR, kept.rgb), deviations, kernel)
    families = shipped_library(families_with(materials(kept.name).measured))
    priors = {
        "coefficients kriged, nugget near entries": Prior(MODEL, SENSOR, smooth, kriging),
        "kernel learnt": _prior(known, smooth),
        "library, all relevances 1": _prior(known, _base(families, known.rows(slice(0)))),
        "relevances learnt: the prior": _prior(known, _base(families, known)),
    }
    for label, prior in priors.items():
        yield label, solved(MODEL, prior(queried.rgb), queried.rgb)


def _prior(known: FittedEntries, base: Base) -> Prior:
    return fit_prior(PROBLEM, known, base)


def _base(families: tuple[Family, ...], known: FittedEntries) -> Base:
    return learn_base(PROBLEM, families, known)[0]
