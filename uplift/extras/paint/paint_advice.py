"""Which samples to prepare and measure next, from the posterior of a fit of paints.

The aim is to predict mixtures of any two paints in equal parts, on an opaque ground.
Their expected error follows from the covariance of the fit, and what a sample would
leave of it from one step of Kalman's update. The sample that leaves least comes first,
then the best one in addition to it, and so on.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000_weights
from uplift.common.arrays import Array
from uplift.extras.paint.paint_fit import FitModel, PaintFit
from uplift.extras.paint.paint_samples import MeasuredSpectra, PaintSamples
from uplift.extras.paint.paints import TINT_PARTS

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
    samples = fit.samples
    alone = np.eye(len(samples.paints))
    pairs = [(first + second) / 2 for first, second in combinations(alone, 2)]
    aimed = _opaque(samples, pairs or alone)
    weights = delta_e_2000_weights(np.asarray(fit.model.colours(fit.optimum, aimed)))
    slopes = _jacobian(fit, FitModel.colours, aimed)
    aims = (weights @ slopes).reshape(3 * len(aimed), -1)
    candidates = _candidates(samples)
    rows = _measurements(fit, _opaque(samples, candidates.values()))
    left = dict(zip(candidates, rows, strict=True))
    covariance = fit.covariance
    error = _mean_error((aims.T * (covariance @ aims.T)).sum(axis=0))
    advice = list[NextSample]()
    while left and len(advice) < count:
        # C Hᵀ (H C Hᵀ + 1)⁻¹ H C is what a measurement with the Jacobian H takes off C.
        projected = covariance @ aims.T
        variances = (aims.T * projected).sum(axis=0)
        roots = {name: _gain_root(covariance, row) @ row for name, row in left.items()}
        errors = {
            name: _mean_error(variances - ((root @ projected) ** 2).sum(axis=0))
            for name, root in roots.items()
        }
        best = min(errors, key=errors.__getitem__)
        advice.append(NextSample(best, errors[best]))
        gain = roots[best] @ covariance
        covariance = covariance - gain.T @ gain
        del left[best]
    return PaintAdvice(error, tuple(advice))


def _measurements(fit: PaintFit, candidates: PaintSamples) -> Array:
    """Return the Jacobians (n, r, d) of candidates, in units of the noise, measured as
    the samples are.
    """
    function: Callable[..., Any] = FitModel.colours
    if isinstance(fit.samples.measured, MeasuredSpectra):
        function = FitModel.reflectances
    spread = fit.noise.spread(np.asarray(function(fit.model, fit.optimum, candidates)))
    return _jacobian(fit, function, candidates) / spread[..., None]


def _gain_root(covariance: Array, row: Array) -> Array:
    """Return W with Wᵀ W = (H C Hᵀ + 1)⁻¹ for a Jacobian H (r, d)."""
    inner = row @ covariance @ row.T + np.eye(len(row))
    return np.linalg.inv(np.linalg.cholesky(inner))


def _mean_error(variances: Array) -> float:
    """Return the mean distance of colours with variances (3 n,)."""
    sums = np.maximum(variances, 0).reshape(-1, 3).sum(axis=1)
    return float(np.sqrt(sums).mean())


def _jacobian(
    fit: PaintFit, function: Callable[..., Any], samples: PaintSamples
) -> Array:
    """Return the Jacobian (n, r, d) of what a function of the model predicts."""
    import jax

    from uplift.common.compilation import compiled

    def predict(z: Any) -> Any:
        return function(fit.model, z, samples)

    with jax.enable_x64(True):
        return np.asarray(compiled(jax.jacfwd(predict))(fit.optimum))


def _opaque(samples: PaintSamples, rows: Iterable[Array]) -> PaintSamples:
    """Return opaque samples with rows of shares (P,) that are not measured."""
    shares = np.reshape(list(rows), (-1, len(samples.paints)))
    size = len(shares)
    return replace(
        samples,
        names=("",) * size,
        shares=shares,
        thickness=np.full(size, np.inf),
        grounds=np.ones((size, len(samples.wavelengths))),
    )


def _candidates(samples: PaintSamples) -> dict[str, Array]:
    """Return the shares of opaque samples that are not measured, by name: each paint
    alone, its tint with the lightest paint, and mixtures of two in equal parts.
    """
    names = samples.paints
    alone = np.eye(len(names))
    white = _lightest(samples)
    shares = dict[str, Array]()
    for name, row in zip(names, alone, strict=True):
        shares[name] = row
        if name != names[white]:
            tint = (row + TINT_PARTS * alone[white]) / (1 + TINT_PARTS)
            shares[f"1 {name} : {TINT_PARTS} {names[white]}"] = tint
    for first, second in combinations(range(len(names)), 2):
        pair = (alone[first] + alone[second]) / 2
        shares[f"1 {names[first]} : 1 {names[second]}"] = pair
    known = samples.shares[samples.is_opaque]
    return {
        name: row
        for name, row in shares.items()
        if np.abs(known - row).max(axis=1).min(initial=1.0) > KNOWN
    }


def _lightest(samples: PaintSamples) -> int:
    """Return the paint of the sample of one paint that reflects most, usually white."""
    purity = samples.shares.max(axis=1)
    light = np.where(purity > 1 - KNOWN, samples.measured.values.min(axis=1), -1)
    return int(samples.shares[light.argmax()].argmax())
