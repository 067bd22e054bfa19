"""Between the entries: which kriging, over which distance, in which metric."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import numpy as np

from benchmarks.fidelity.materials import SENSOR, Materials, ahead, entries, large, materials
from benchmarks.fidelity.start import solved
from benchmarks.page import table
from uplift.colorimetry.delta_e import rgb_to_lab
from uplift.common.arrays import Array
from uplift.fit.kriging import LENGTH, krige
from uplift.fit.smooth import smooth
from uplift.lab.study.held_out import spectrum_errors
from uplift.models import Moments

SPLITS = 3
LENGTHS = (3.0, 4.0, 6.0, 8.0, 10.0, 14.0)
Predict = Callable[[Array, Array, Array, Array], tuple[Array, Array | None]]
"""Of colours and deviations known, colours asked, and roughness: deviations there, and the inverse metric."""


def sections() -> list[str]:
    return [_lengths(), _designs()]


def _lengths() -> str:
    rows = []
    for name, count in product(("rawtoaces", "babelcolor", *large()[1:], "macbeth"), (9, 17)):
        some, model = materials(name), Moments(count)
        own = entries(model, some).multipliers
        plain = smooth(model, ahead(model))(some.rgb)
        without = spectrum_errors(solved(model, plain, some.rgb), some.measured).means()
        cells = [name, str(count)]
        for length in LENGTHS:
            _, left_out = krige(rgb_to_lab(SENSOR, some.rgb), own - plain, length)
            ratio = (
                spectrum_errors(solved(model, plain + left_out, some.rgb), some.measured).means() / without
            )
            cells.append(f"{ratio[1:].mean():.3f} / {ratio[1:].max():.2f}")
        rows.append(cells)
    return table(
        "Between entries: how far an entry is heard",
        "Every entry left out in turn, its spectrum kriged from the others with correlation exp(−ΔE*ab / length): mean "
        "over the lights of ΔE00, in shares of ΔE00 without an atlas / the worst light. "
        f"The default length, {LENGTH:g}, was chosen on rawtoaces and babelcolor: a shorter one hears too little, a "
        "longer one lets unrelated materials speak for each other.",
        ["atlas", "coefficients", *(f"{length:g}" for length in LENGTHS)],
        rows,
    )


def _designs() -> str:
    rows = []
    for name in large():
        for label, predict in DESIGNS.items():
            scores = [_score(materials(name), Moments(9), predict, seed) for seed in range(SPLITS)]
            ratio, ratios = np.mean(scores, axis=0), np.array(scores)[:, 1:].mean(axis=1)
            rows.append(
                [name, label, f"{ratio[0]:.3f}", f"{ratio[1:].mean():.3f} ± {ratios.std():.3f}",
                 f"{ratio[1:].max():.2f}"]
            )  # fmt: skip
    return table(
        "Between entries: which kriging",
        f"Half of each atlas known, the other half asked, {SPLITS} times; 9 coefficients. In shares of what the same "
        "model makes without an atlas: rms, mean over the lights of ΔE00 ± its spread over the splits, worst light. "
        "*Smooth spectra* are those of the start above; a quadratic trend is over cube-root RGB with a Gaussian kernel "
        "of length 0.1 and nugget 0.1; *metric of the residuals* moves each prior to its colour in the covariance of "
        "leave-one-out residuals, shrunk to smoothness as 10 entries' worth.",
        ["atlas", "prior", "rms", "lights", "worst light"],
        rows,
    )


def _score(some: Materials, model: Moments, predict: Predict, seed: int) -> Array:
    kept, asked = np.array_split(np.random.default_rng(seed).permutation(len(some.rgb)), 2)
    own = entries(model, some.take(kept)).multipliers
    plain = smooth(model, ahead(model))
    offset = 0 if predict in OF_WHOLE else 1
    known = own - offset * plain(some.rgb[kept])
    deviation, metric = predict(some.rgb[kept], known, some.rgb[asked], model.roughness())
    start = deviation + offset * plain(some.rgb[asked])
    answered = solved(model, start, some.rgb[asked], metric)
    return _ratio(answered, solved(model, plain(some.rgb[asked]), some.rgb[asked]), some.measured[asked])


def _ratio(answered: Array, without: Array, measured: Array) -> Array:
    return spectrum_errors(answered, measured).means() / spectrum_errors(without, measured).means()


def _chosen(known: Array, values: Array, asked: Array, roughness: Array) -> tuple[Array, None]:
    found, _ = krige(rgb_to_lab(SENSOR, known), values)
    return found(rgb_to_lab(SENSOR, asked)), None


def _chosen_in_metric(known: Array, values: Array, asked: Array, roughness: Array) -> tuple[Array, Array]:
    found, left_out = krige(rgb_to_lab(SENSOR, known), values)
    return found(rgb_to_lab(SENSOR, asked)), _covariance(values - left_out, roughness)


def _nearest(known: Array, values: Array, asked: Array, roughness: Array) -> tuple[Array, None]:
    apart = np.linalg.norm(rgb_to_lab(SENSOR, known)[None] - rgb_to_lab(SENSOR, asked)[:, None], axis=-1)
    return values[apart.argmin(axis=1)], None


def _nothing(known: Array, values: Array, asked: Array, roughness: Array) -> tuple[Array, None]:
    return np.zeros((len(asked), values.shape[1])), None


def _trend(known: Array, values: Array, asked: Array, roughness: Array) -> tuple[Array, Array]:
    found, residuals = _universal(known, values, asked)
    return found, _covariance(residuals, roughness)


def _universal(known: Array, values: Array, asked: Array) -> tuple[Array, Array]:
    """Quadratic trend, Gaussian kernel of length 0.1 and nugget 0.1 over cube-root RGB; leave-one-out residuals."""
    x, y = np.cbrt(known), np.cbrt(asked)
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
    "deviation from smooth spectra, simple kriging, the default": _chosen,
    "the same, metric of the residuals": _chosen_in_metric,
}
OF_WHOLE = (_nearest, _trend)
"""Those that predict multipliers, not their deviation from smooth spectra."""


def _whole_deviations(kept: Materials, asked: Materials) -> Array:
    model = Moments(9)
    plain = smooth(model, ahead(model))
    before, after = (solved(model, plain(part.rgb), part.rgb) for part in (kept, asked))
    found, _ = krige(rgb_to_lab(SENSOR, kept.rgb), kept.measured - before)
    return np.asarray(after + found(rgb_to_lab(SENSOR, asked.rgb)))


def _whole_trend(kept: Materials, asked: Materials) -> Array:
    return _universal(kept.rgb, kept.measured, asked.rgb)[0]


LIMITS: dict[str, Callable[[Materials, Materials], Array]] = {
    "81 samples, deviations kriged as here": _whole_deviations,
    "81 samples, quadratic trend": _whole_trend,
}
"""Kriging of whole spectra, neither bounded nor compact, nor of the very colour."""
