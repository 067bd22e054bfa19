"""Interpolation between entries: learnt kernels, and kinds of kriging."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from itertools import product
from typing import Any

import numpy as np
from scipy.spatial.distance import cdist

from benchmarks.fidelity.materials import SENSOR, Materials, entries, forward, large, materials, problem_of
from benchmarks.fidelity.start import solved
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import rgb_to_lab
from uplift.common.arrays import Array, Indices
from uplift.fit.base import smooth
from uplift.fit.kriging import DEFAULT, Kernel, Kriging, krige
from uplift.fit.prior import Prior, fit_prior
from uplift.lab.study.held_out import spectrum_errors
from uplift.models import Model, Moments
from uplift.pipeline.options import Options

SPLITS = 3
Predict = Callable[[Materials, Materials, Model], Array]
"""From known to queried materials: multipliers to start from."""
LIGHTS = [observer.light(name) for name in Options.lights]
LIMIT_LENGTHS, LIMIT_NUGGETS = (6.0, 12.0, 18.0, 24.0, 36.0, 48.0), (0.01, 0.03, 0.1, 0.3, 1.0, 2.0)
"""Hyperparameters of the limits, the best of which is found with the errors themselves."""


def measure() -> dict[str, Any]:
    """Learn kernels, then vary the kind of kriging."""
    return {
        "splits": SPLITS,
        "kernels": [
            kernel(name, count) for name, count in product((*large(), "macbeth", "babelcolor", "pmc"), (9, 17))
        ],
        "kriging": [kriging(name, label) for name in large() for label in DESIGNS],
    }


def kernel(name: str, count: int) -> dict[str, Any]:
    """Return the kernel that is learnt from an atlas."""
    prior = _prior(materials(name), Moments(count))
    return {"atlas": name, "entries": len(materials(name).rgb), "coefficients": count, **prior.describe()}


def kriging(name: str, label: str) -> dict[str, Any]:
    """Return the errors of one half of an atlas predicted from the other, relative to no atlas."""
    scores = np.array([_score(materials(name), Moments(9), DESIGNS[label], seed) for seed in range(SPLITS)])
    rms, *lights = scores.mean(axis=0).tolist()
    spread = {"mean": float(np.mean(lights)), "std": float(scores[:, 1:].mean(axis=1).std())}
    return {"atlas": name, "prior": label, "rms": rms, "lights": spread, "worst_light": max(lights)}


def _score(some: Materials, model: Moments, predict: Predict, seed: int) -> Array:
    kept, queried = (some.take(rows) for rows in split(some, seed))
    spectra = solved(model, predict(kept, queried, model), queried.rgb)
    without = solved(model, _smooth(kept, queried, model), queried.rgb)
    ours, theirs = (spectrum_errors(each, queried.measured).means() for each in (spectra, without))
    return ours / theirs


def split(some: Materials, seed: int) -> list[Indices]:
    """Return the rows of the known and of the other half."""
    return np.array_split(np.random.default_rng(seed).permutation(len(some.rgb)), 2)


def _prior(some: Materials, model: Model) -> Prior:
    return fit_prior(problem_of(model), entries(model, some))


def _smooth(known: Materials, queried: Materials, model: Model) -> Array:
    return smooth(model, forward(model))(queried.rgb)


def _default(known: Materials, queried: Materials, model: Model) -> Array:
    return _prior(known, model)(queried.rgb)


def _nearest(known: Materials, queried: Materials, model: Model) -> Array:
    distance = cdist(rgb_to_lab(SENSOR, queried.rgb), rgb_to_lab(SENSOR, known.rgb))
    return entries(model, known).multipliers[distance.argmin(axis=1)]


def _multipliers(known: Materials, queried: Materials, model: Model) -> Array:
    """Deviations of multipliers, kriged with a short length and hardly any nugget."""
    interpolate = _deviations(known, entries(model, known).multipliers - _smooth(known, known, model), SHORT)
    return np.asarray(_smooth(known, queried, model) + interpolate(rgb_to_lab(SENSOR, queried.rgb)))


def _coefficients(chosen: Kernel, known: Materials, queried: Materials, model: Model) -> Array:
    """Deviations of coefficients, kriged with a given kernel."""
    prior = _prior(known, model)
    own = model.to_storage(entries(model, known).multipliers)
    return replace(prior, kriging=_deviations(known, own - prior.base.coefficients(known.rgb), chosen))(queried.rgb)


def _deviations(known: Materials, deviations: Array, chosen: Kernel) -> Kriging:
    return krige(rgb_to_lab(SENSOR, known.rgb), deviations, chosen)[0]


SHORT = Kernel(length=6.0, nugget=0.0)
DESIGNS: dict[str, Predict] = {
    "nothing: without an atlas": _smooth,
    "multipliers of the nearest entry": _nearest,
    "deviations of multipliers, length 6, no nugget": _multipliers,
    "deviations of coefficients, length 6, no nugget": partial(_coefficients, SHORT),
    "deviations of coefficients, length 12, nugget 0.3": partial(_coefficients, DEFAULT),
    "deviations of coefficients, learnt, the default": _default,
}


@cache
def limit_kernel(name: str) -> tuple[float, float]:
    """Return the length and the nugget that are the best for the held-out halves themselves, over all lights."""
    trials = product(LIMIT_LENGTHS, LIMIT_NUGGETS)
    return min(trials, key=lambda trial: limit(name, *trial)[1:].mean())


@cache
def limit(name: str, length: float, nugget: float) -> Array:
    """Return the errors of kriged spectra of 81 samples: mean rms, and mean ΔE00 under each light.

    The spectra are neither compact, nor within [0, 1], nor of the exact colour.
    """
    scores = []
    for seed in range(SPLITS):
        kept, queried = (materials(name).take(rows) for rows in split(materials(name), seed))
        predicted = krige_samples(kept, queried, length, nugget)
        scores.append(spectrum_errors(predicted, queried.measured).means())
    return np.asarray(np.mean(scores, axis=0))


def krige_samples(kept: Materials, queried: Materials, length: float, nugget: float) -> Array:
    """Predict reflectances (n, 81) from the deviations of known ones from smooth spectra."""
    model = Moments(17)
    before, after = (solved(model, _smooth(part, part, model), part.rgb) for part in (kept, queried))
    labs = [rgb_to_lab(SENSOR, part.rgb) for part in (kept, queried)]
    covariance = np.exp(-cdist(labs[0], labs[0]) / length) + nugget * np.eye(len(kept.rgb))
    weights = np.linalg.solve(covariance, kept.measured - before)
    return np.asarray(after + np.exp(-cdist(labs[1], labs[0]) / length) @ weights)
