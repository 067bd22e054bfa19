"""Interpolation between entries: kind, correlation length and metric of the kriging."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from typing import Any

import numpy as np

from benchmarks.fidelity.materials import SENSOR, Materials, entries, forward, large, materials
from benchmarks.fidelity.start import solved
from uplift.colorimetry.delta_e import rgb_to_lab
from uplift.common.arrays import Array
from uplift.fit.kriging import LENGTH, krige
from uplift.fit.smooth import smooth
from uplift.lab.study.held_out import spectrum_errors
from uplift.models import Moments

SPLITS = 3
LENGTHS = (3.0, 4.0, 6.0, 8.0, 10.0, 14.0)
Predict = Callable[[Array, Array, Array, Array], tuple[Array, Array | None]]
"""From known colours and deviations, queried colours and roughness to deviations there and the inverse metric."""


def measure() -> dict[str, Any]:
    """Vary the correlation length, then the kind of kriging."""
    atlases = ("rawtoaces", "babelcolor", *large()[1:], "macbeth")
    return {
        "default_length": LENGTH,
        "splits": SPLITS,
        "lengths": [lengths(name, count) for name, count in product(atlases, (9, 17))],
        "kriging": [kriging(name, label) for name in large() for label in DESIGNS],
    }


def lengths(name: str, count: int) -> dict[str, Any]:
    """Return ΔE00 of left-out entries relative to no atlas, [mean over the lights, worst light], by length."""
    some, model = materials(name), Moments(count)
    own = entries(model, some).multipliers
    plain = smooth(model, forward(model))(some.rgb)
    without = spectrum_errors(solved(model, plain, some.rgb), some.measured).means()
    ratios = {}
    for length in LENGTHS:
        _, left_out = krige(rgb_to_lab(SENSOR, some.rgb), own - plain, length)
        spectra = solved(model, plain + left_out, some.rgb)
        ratio = spectrum_errors(spectra, some.measured).means()[1:] / without[1:]
        ratios[f"{length:g}"] = [float(ratio.mean()), float(ratio.max())]
    return {"atlas": name, "coefficients": count, "ratios": ratios}


def kriging(name: str, label: str) -> dict[str, Any]:
    """Return the errors of one half of an atlas predicted from the other, relative to no atlas."""
    scores = np.array([_score(materials(name), Moments(9), DESIGNS[label], seed) for seed in range(SPLITS)])
    rms, *lights = scores.mean(axis=0).tolist()
    spread = {"mean": float(np.mean(lights)), "std": float(scores[:, 1:].mean(axis=1).std())}
    return {"atlas": name, "prior": label, "rms": rms, "lights": spread, "worst_light": max(lights)}


def _score(some: Materials, model: Moments, predict: Predict, seed: int) -> Array:
    kept, queried = np.array_split(np.random.default_rng(seed).permutation(len(some.rgb)), 2)
    own = entries(model, some.take(kept)).multipliers
    plain = smooth(model, forward(model))
    offset = 0 if predict in OF_MULTIPLIERS else 1
    known = own - offset * plain(some.rgb[kept])
    deviation, metric = predict(some.rgb[kept], known, some.rgb[queried], model.roughness())
    start = deviation + offset * plain(some.rgb[queried])
    spectra = solved(model, start, some.rgb[queried], metric)
    return _ratio(spectra, solved(model, plain(some.rgb[queried]), some.rgb[queried]), some.measured[queried])


def _ratio(spectra: Array, without: Array, measured: Array) -> Array:
    return spectrum_errors(spectra, measured).means() / spectrum_errors(without, measured).means()


def _default(known: Array, values: Array, queried: Array, roughness: Array) -> tuple[Array, None]:
    interpolate, _ = krige(rgb_to_lab(SENSOR, known), values)
    return interpolate(rgb_to_lab(SENSOR, queried)), None


def _default_in_metric(known: Array, values: Array, queried: Array, roughness: Array) -> tuple[Array, Array]:
    interpolate, left_out = krige(rgb_to_lab(SENSOR, known), values)
    return interpolate(rgb_to_lab(SENSOR, queried)), _covariance(values - left_out, roughness)


def _nearest(known: Array, values: Array, queried: Array, roughness: Array) -> tuple[Array, None]:
    distance = np.linalg.norm(rgb_to_lab(SENSOR, known)[None] - rgb_to_lab(SENSOR, queried)[:, None], axis=-1)
    return values[distance.argmin(axis=1)], None


def _nothing(known: Array, values: Array, queried: Array, roughness: Array) -> tuple[Array, None]:
    return np.zeros((len(queried), values.shape[1])), None


def _trend(known: Array, values: Array, queried: Array, roughness: Array) -> tuple[Array, Array]:
    values, residuals = _universal(known, values, queried)
    return values, _covariance(residuals, roughness)


def _universal(known: Array, values: Array, queried: Array) -> tuple[Array, Array]:
    """Quadratic trend, Gaussian kernel of length 0.1 and nugget 0.1 over cube-root RGB; leave-one-out residuals."""
    x, y = np.cbrt(known), np.cbrt(queried)
    count = len(x)
    trend = _quadratic(x)
    system = np.block([[_gauss(x, x) + 0.1 * np.eye(count), trend], [trend.T, np.zeros((10, 10))]])
    inverse = np.linalg.pinv(system)
    weights = inverse[:, :count] @ values
    residuals = weights[:count] / np.diag(inverse)[:count, None]
    return np.hstack([_gauss(y, x), _quadratic(y)]) @ weights, residuals


def _gauss(first: Array, second: Array) -> Array:
    return np.exp(-((first[:, None] - second[None]) ** 2).sum(axis=-1) / 0.02)


def _quadratic(x: Array) -> Array:
    pairs = [x[:, i] * x[:, j] for i in range(3) for j in range(i + 1)]
    return np.stack([np.ones(len(x)), *x.T, *pairs], axis=1)


def _covariance(residuals: Array, roughness: Array) -> Array:
    total = residuals.T @ residuals
    scale = (np.diag(total) * roughness).mean() / len(residuals)
    return (total + 10 * scale * np.diag(1 / roughness)) / (len(residuals) + 10)


DESIGNS: dict[str, Predict] = {
    "nothing: without an atlas": _nothing,
    "multipliers of the nearest entry": _nearest,
    "multipliers, quadratic trend, metric of the residuals": _trend,
    "deviation from smooth spectra, simple kriging, the default": _default,
    "the same, metric of the residuals": _default_in_metric,
}
OF_MULTIPLIERS = (_nearest, _trend)
"""Designs that predict multipliers, not their deviation from smooth spectra."""


def _spectra_deviations(kept: Materials, queried: Materials) -> Array:
    model = Moments(9)
    plain = smooth(model, forward(model))
    before, after = (solved(model, plain(part.rgb), part.rgb) for part in (kept, queried))
    interpolate, _ = krige(rgb_to_lab(SENSOR, kept.rgb), kept.measured - before)
    return np.asarray(after + interpolate(rgb_to_lab(SENSOR, queried.rgb)))


def _spectra_trend(kept: Materials, queried: Materials) -> Array:
    return _universal(kept.rgb, kept.measured, queried.rgb)[0]


LIMITS: dict[str, Callable[[Materials, Materials], Array]] = {
    "81 samples, deviations kriged as here": _spectra_deviations,
    "81 samples, quadratic trend": _spectra_trend,
}
"""Kriging of complete spectra, which is neither bounded nor compact, and not exact in colour."""
