"""Which samples to prepare and measure next, from the posterior of a fit of paints.

The aim is to predict mixtures of any two paints in equal parts, on an opaque ground.
Their expected error follows from the covariance of the fit, and what a sample would
leave of it from one step of Kalman's update. The sample that leaves least comes first,
then the best one in addition to it, and so on.
"""

from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000_weights
from uplift.common.arrays import Array
from uplift.extras.paint.paint_fit import PaintFit
from uplift.extras.paint.paint_samples import MeasuredSpectra, PaintSamples

TINT_PARTS = 4
"""Parts of white to one of paint in a tint."""
KNOWN = 0.02
"""Difference of shares below which a sample is measured already."""


@dataclass(frozen=True)
class NextSample:
    """A sample worth measuring.

    Parameters
    ----------
    name : str
        The sample, such as ``"1 cobalt blue : 4 titanium white"``.
    error : float
        Expected ΔE00 of mixtures after it and those before it are measured.
    """

    name: str
    error: float


@dataclass(frozen=True)
class PaintAdvice:
    """The expected error of mixtures, and the samples that lower it most.

    Parameters
    ----------
    error : float
        Expected ΔE00 of mixtures of two paints in equal parts.
    samples : tuple of NextSample
        The best first; the others add to it.
    """

    error: float
    samples: tuple[NextSample, ...]


def advise_samples(fit: PaintFit, count: int = 5) -> PaintAdvice:
    """Name the samples whose measurement lowers the errors of mixtures most.

    Parameters
    ----------
    fit : PaintFit
        Fitted paints.
    count : int
        Number of samples.

    Returns
    -------
    PaintAdvice
        Mean standard deviation in units of ΔE00 of the colours of mixtures of two
        paints, or of the only one, now and after each sample.
    """
    pairs = _pairs(fit.samples)
    names, candidates = _candidates(fit.samples)
    weights = delta_e_2000_weights(np.asarray(fit.model.colours(fit.optimum, pairs)))
    colours = _jacobian(fit, pairs, "colours").reshape(len(pairs), 3, -1)
    aims = (weights @ colours).reshape(3 * len(pairs), -1)
    rows = _measurements(fit, candidates)
    covariance = fit.covariance
    advice = list[NextSample]()
    left = list(range(len(names)))
    while left and len(advice) < count:
        # C Hᵀ (H C Hᵀ + 1)⁻¹ H C is what a measurement with the Jacobian H takes off C.
        projected = covariance @ aims.T
        variances = (aims.T * projected).sum(axis=0)
        roots = [_gain_root(covariance, rows[row]) @ rows[row] for row in left]
        taken = [((root @ projected) ** 2).sum(axis=0) for root in roots]
        errors = [_mean_error(variances - reduction) for reduction in taken]
        best = int(np.argmin(errors))
        advice.append(NextSample(names[left[best]], errors[best]))
        gain = roots[best] @ covariance
        covariance = covariance - gain.T @ gain
        del left[best]
    variances = (aims.T * (fit.covariance @ aims.T)).sum(axis=0)
    return PaintAdvice(_mean_error(variances), tuple(advice))


def _measurements(fit: PaintFit, candidates: PaintSamples) -> Array:
    """Return the Jacobians (n, r, d) of candidates, in units of the noise, measured as
    the samples are.
    """
    name = "colours"
    if isinstance(fit.samples.measured, MeasuredSpectra):
        name = "reflectances"
    predicted = np.asarray(getattr(fit.model, name)(fit.optimum, candidates))
    spread = fit.noise.spread(predicted)
    return _jacobian(fit, candidates, name) / spread[..., None]


def _gain_root(covariance: Array, row: Array) -> Array:
    """Return W with Wᵀ W = (H C Hᵀ + 1)⁻¹ for a Jacobian H (r, d)."""
    inner = row @ covariance @ row.T + np.eye(len(row))
    return np.linalg.inv(np.linalg.cholesky(inner))


def _mean_error(variances: Array) -> float:
    """Return the mean distance of colours with variances (3 n,)."""
    sums = np.maximum(variances, 0).reshape(-1, 3).sum(axis=1)
    return float(np.sqrt(sums).mean())


def _jacobian(fit: PaintFit, samples: PaintSamples, name: str) -> Array:
    import jax

    from uplift.common.compilation import compiled

    function = getattr(fit.model, name)

    def predict(z: Any) -> Any:
        return function(z, samples)

    with jax.enable_x64(True):
        return np.asarray(compiled(jax.jacfwd(predict))(fit.optimum))


def _pairs(samples: PaintSamples) -> PaintSamples:
    """Return mixtures of any two paints in equal parts, or the only paint."""
    count = len(samples.paints)
    if count == 1:
        return _opaque(samples, np.eye(1))
    pairs = np.array(list(combinations(range(count), 2)))
    return _opaque(samples, np.eye(count)[pairs].mean(axis=1))


def _opaque(samples: PaintSamples, shares: Array) -> PaintSamples:
    size = len(shares)
    return PaintSamples(
        ("",) * size,
        samples.paints,
        shares,
        np.full(size, np.inf),
        np.ones((size, len(samples.wavelengths))),
        samples.wavelengths,
        MeasuredSpectra(np.empty((size, 0))),
    )


def _candidates(samples: PaintSamples) -> tuple[list[str], PaintSamples]:
    """Return the opaque samples that are not measured: each paint alone, its tint with
    the lightest paint, and mixtures of two in equal parts.
    """
    count = len(samples.paints)
    lightest = _lightest(samples)
    shares = dict[str, Array]()
    for paint, name in enumerate(samples.paints):
        shares[name] = np.eye(count)[paint]
        if paint != lightest:
            tint = f"1 {name} : {TINT_PARTS} {samples.paints[lightest]}"
            row = np.zeros(count)
            row[paint] = 1
            row[lightest] = TINT_PARTS
            shares[tint] = row / row.sum()
    for first, second in combinations(range(count), 2):
        name = f"1 {samples.paints[first]} : 1 {samples.paints[second]}"
        shares[name] = np.eye(count)[[first, second]].mean(axis=0)
    opaque = samples.shares[samples.is_opaque]
    names = []
    for name, row in shares.items():
        distance = np.abs(opaque - row).max(axis=1).min(initial=1.0)
        if distance > KNOWN:
            names.append(name)
    rows = np.array([shares[name] for name in names]).reshape(-1, count)
    return names, _opaque(samples, rows)


def _lightest(samples: PaintSamples) -> int:
    """Return the paint of the sample of one paint that reflects most, usually white."""
    purity = samples.shares.max(axis=1)
    light = np.where(purity > 1 - KNOWN, samples.measured.values.min(axis=1), -1)
    return int(samples.shares[light.argmax()].argmax())
