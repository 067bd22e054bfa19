"""Absorption and scattering of paints by least squares on measured samples.

The samples are predicted by the two constants of Kubelka and Munk, mixed by Duncan's
rule and measured through a surface by Saunderson's correction (`optics`, `pigments`).
All that the samples do not determine stays as the prior has it (`paint_prior`): the fit
is the maximum of the posterior, and its curvature gives standard errors. A paint that
is known by one opaque sample only keeps the scattering that a rule assumes.

The measured values weigh by their uncertainty. If the samples fit worse than that, it
is raised until they fit as expected, since the theory or the parts are then the limit.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import count
from typing import Any

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Indices
from uplift.common.errors import OptionError, UpliftWarning, warn
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.common.text import pluralise
from uplift.extras.paint.optics import Surface, beneath_surface, through_surface
from uplift.extras.paint.paint_prior import STRENGTH_SPREAD, PaintPrior, paint_prior
from uplift.extras.paint.paint_samples import (
    MeasuredColours,
    MeasuredSpectra,
    Noise,
    PaintSamples,
)
from uplift.extras.paint.paints import Paints
from uplift.extras.paint.pigments import Pigment
from uplift.models.least_squares import least_squares

INSIDE = 0.6
"""Internal reflectance of the surface that is expected: an index of 1.5."""
INSIDE_SPREAD = 0.5
"""Standard deviation of its logit."""
MAX_OUTSIDE = 0.05
"""Largest reflectance of the surface that is fitted."""
DARKEST = 0.02
"""Fraction of the measured reflectances that may lie below that of the surface."""
SURFACE_COUNT = 2
"""Variables of the surface."""
PRECISION = 1e-3
"""Relative change of the objective, or of the variables, at which a fit ends."""
MAX_STEPS = 200
ROUNDS = 4
"""Fits with the noise of the one before."""
STEADY = 1.1
"""Increase of the noise up to which no further round follows."""
LEAST_FREEDOM = 0.05
"""Smallest fraction of the measured values that the unknowns leave free."""
MAX_VARIABLES = 6000
"""Largest number of unknowns, whose square must fit in memory."""
ODD = 3.0
"""ΔE00, in that of the median sample, from which a sample may be wrong."""

Function = Callable[[Array], Any]
"""A compiled function of the variables (d,)."""


@dataclass(frozen=True, eq=False)
class PaintFit:
    """Fitted paints, and what they make of the samples.

    Parameters
    ----------
    paints : Paints
        The paints, with standard errors.
    samples : PaintSamples
        The samples that they were fitted to.
    delta_e : ndarray, shape (n,)
        ΔE00 under D65 between each sample and its prediction.
    noise : Noise
        How far the samples differ from the predictions, at least the noise of
        measurements.
    optimum : ndarray, shape (d,)
        Independent variables at the maximum of the posterior.
    covariance : ndarray, shape (d, d)
        Their covariance.
    model : FitModel
        Maps variables to predictions.
    """

    paints: Paints
    samples: PaintSamples
    delta_e: Array
    noise: Noise
    optimum: Array
    covariance: Array
    model: "FitModel"

    @property
    def doubtful(self) -> list[int]:
        """Samples that fit so much worse than the median one that their parts or
        measurements may be wrong, the worst first.
        """
        limit = max(ODD * float(np.median(self.delta_e)), 1.0)
        order = np.argsort(-self.delta_e)
        return order[self.delta_e[order] > limit].tolist()


@dataclass(frozen=True, eq=False)
class FitModel:
    """Predictions as functions of independent standard normal variables: those of the
    paints, then those of the surface if it is unknown.
    """

    prior: PaintPrior
    surface: Surface | None
    max_outside: float
    sensor: Sensor

    @property
    def count(self) -> int:
        """Number of variables."""
        return self.prior.count + (SURFACE_COUNT if self.surface is None else 0)

    def surface_of(self, z: Any) -> tuple[Any, Any]:
        """Return the reflectances of the surface, from outside and from within."""
        if self.surface is not None:
            return self.surface.outside, self.surface.inside
        xp = z.__array_namespace__()
        outside = self.max_outside / (1 + xp.exp(-z[-2]))
        logit = np.log(INSIDE / (1 - INSIDE)) + INSIDE_SPREAD * z[-1]
        return outside, 1 / (1 + xp.exp(-logit))

    def pigments(self, z: Any) -> Pigment:
        """Return K and S of the paints."""
        return self.prior.pigments(z[: self.prior.count])

    def reflectances(self, z: Any, samples: PaintSamples) -> Any:
        """Return the reflectances (n, N) of samples."""
        paints = self.pigments(z)
        mixed = Pigment(
            samples.shares @ paints.absorption, samples.shares @ paints.scattering
        )
        outside, inside = self.surface_of(z)
        internal = mixed.opaque_reflectance()
        if not samples.is_opaque.all():
            xp = z.__array_namespace__()
            film = np.where(samples.is_opaque, 1.0, samples.thickness)
            ground = beneath_surface(samples.grounds, outside, inside)
            covered = mixed.layer(film).over(xp.clip(ground, 0, 1))
            internal = xp.where(samples.is_opaque[:, None], internal, covered)
        return through_surface(internal, internal, outside, inside)

    def colours(
        self, z: Any, samples: PaintSamples, low: Any = 0.0, high: Any = 1.0
    ) -> Any:
        """Return CIE L*a*b* (n, 3) of samples, whose linear sRGB is clipped to [low,
        high].
        """
        xp = z.__array_namespace__()
        rgb = self.reflectances(z, samples) @ self.sensor.matrix.T
        return _lab(xp.clip(rgb, low, high), self.sensor)

    def differences(self, z: Any, samples: PaintSamples) -> Any:
        """Return predicted less measured reflectances, or L*, a* and b*."""
        values = samples.measured.values
        if isinstance(samples.measured, MeasuredSpectra):
            return self.reflectances(z, samples) - values
        # A channel inside [0, 1] was not clipped. To clip its prediction, too, would
        # leave the fit without a derivative where the prediction is outside.
        low = np.where(values <= 0, 0.0, -np.inf)
        high = np.where(values >= 1, 1.0, np.inf)
        return self.colours(z, samples, low, high) - _lab(values, self.sensor)


def fit_paints(
    samples: PaintSamples,
    *,
    surface: Surface | None = None,
    guess: Callable[[Array, Array], Array] | None = None,
    progress: ProgressCallback = ignore_progress,
) -> PaintFit:
    """Fit the absorption and scattering of paints to measured samples.

    Parameters
    ----------
    samples : PaintSamples
        The samples.
    surface : Surface, optional
        Surface of the dry paint; by default it is fitted as well.
    guess : callable, optional
        Reflectances (n, N) of linear sRGB (n, 3) at wavelengths (N,), for samples of
        which only colours are known. By default those of the packaged cube.
    progress : callable, optional
        Receives a `Progress` of stage ``paints`` after each step and each round.

    Returns
    -------
    PaintFit
        The paints, how well they predict each sample, and the posterior.

    Raises
    ------
    OptionError
        There are more unknowns than memory allows (``too-many-paints``).

    Warns
    -----
    UpliftWarning
        The solver has not converged (``paints-not-converged``).

    References
    ----------
    Walowit, McCarthy & Berns 1987, "An algorithm for the optimization of Kubelka-Munk
    absorption and scattering coefficients", Color Research & Application 12.
    """
    import jax

    nm = samples.wavelengths
    sensor = observer.sensor(wavelengths=(nm[0], nm[-1], nm[1] - nm[0]))
    spectra = samples.measured.values
    if isinstance(samples.measured, MeasuredColours):
        spectra = (guess or _packaged_guess)(spectra, nm)
    expected = surface or Surface(0.0, INSIDE)
    prior = paint_prior(samples, spectra, expected, sensor)
    darkest = float(np.clip(np.quantile(spectra, DARKEST), 0, MAX_OUTSIDE))
    model = FitModel(prior, surface, darkest, sensor)
    if model.count > MAX_VARIABLES:
        raise OptionError(
            f"{pluralise(len(samples.paints), 'paint')} at "
            f"{pluralise(len(nm), 'wavelength')} have {model.count} unknowns, more "
            f"than {MAX_VARIABLES}",
            code="too-many-paints",
            hint="fit fewer paints at a time, or measure in steps of 10 nm",
        )
    with jax.enable_x64(True):
        return _fit(samples, model, progress)


def _fit(
    samples: PaintSamples,
    model: FitModel,
    progress: ProgressCallback,
) -> PaintFit:
    import jax

    from uplift.common.compilation import compiled

    values = samples.measured.values
    noise = samples.measured.noise
    z = np.zeros(model.count)

    @compiled
    def evaluate(z: Any) -> Any:
        """Return the differences (m,) to the measured values."""
        return model.differences(z, samples).ravel()

    differentiate = compiled(jax.jacfwd(evaluate))
    for done in range(ROUNDS):
        spread = noise.spread(values).ravel()

        def report(step: int, done: int = done) -> None:
            progress(Progress("paints", done, ROUNDS, step, f"step {step}"))

        z, is_solved = _ascend(evaluate, differentiate, spread, z, report)
        jacobian = np.asarray(differentiate(z)) / spread[:, None]
        precision = jacobian.T @ jacobian + np.eye(model.count)
        covariance: Array = np.linalg.inv(precision).astype(float)
        progress(Progress("paints", done + 1, ROUNDS))
        # The trace counts the variables that the prior, not the samples, determines.
        determined = model.count - np.trace(covariance)
        differences = np.asarray(evaluate(z)).reshape(values.shape)
        freedom = max(1 - determined / differences.size, LEAST_FREEDOM)
        squares = differences**2 / freedom
        last, noise = noise, _estimate_noise(samples, squares)
        excess = np.median(noise.spread(values) / last.spread(values))
        if excess <= STEADY:
            break
    if not is_solved:
        problem = f"the fit stopped after {MAX_STEPS} steps: errors may be larger"
        hint = "check the parts of the samples that fit worst"
        warn(UpliftWarning(problem, code="paints-not-converged", hint=hint))
    paints = _paints(samples, model, z, covariance)
    predicted = np.asarray(model.colours(z, samples))
    colours = _lab(samples.measured.rgb(model.sensor), model.sensor)
    delta_e = delta_e_2000(predicted, np.asarray(colours))
    return PaintFit(paints, samples, delta_e, noise, z, covariance, model)


def _estimate_noise(samples: PaintSamples, squares: Array) -> Noise:
    """Return the noise whose variances, a constant and a part relative to the value,
    fit the squares of the differences best.
    """
    from scipy.optimize import nnls

    smallest = samples.measured.noise
    constant = np.ones(squares.size)
    relative = samples.measured.values.ravel() ** 2 * (smallest.relative > 0)
    variances, _ = nnls(np.stack([constant, relative], axis=1), squares.ravel())
    absolute, proportional = np.sqrt(variances).tolist()
    return Noise(max(absolute, smallest.absolute), max(proportional, smallest.relative))


def _ascend(
    evaluate: Function,
    differentiate: Function,
    spread: Array,
    start: Array,
    report: Callable[[int], None],
) -> tuple[Array, bool]:
    """Return the variables (d,) of the largest posterior, and whether the steps to them
    have converged.

    ``evaluate`` maps variables to the differences (m,) to the measured values, and
    ``differentiate`` to their Jacobian (m, d). ``spread`` (m,) is that of the values.
    """
    steps = count()

    def residuals(y: Array, _: Indices) -> Array:
        report(next(steps))
        return np.append(evaluate(y[0]) / spread, y[0])[None]

    def normal_equations(y: Array, values: Array, _: Indices) -> tuple[Array, Array]:
        jacobian = np.asarray(differentiate(y[0])) / spread[:, None]
        gram = jacobian.T @ jacobian + np.eye(y.size)
        return gram[None], values[:, : -y.size] @ jacobian + y

    found = least_squares(
        residuals,
        normal_equations,
        start[None],
        max_steps=MAX_STEPS,
        precision=PRECISION,
    )
    return found[0], next(steps) <= MAX_STEPS


def _paints(
    samples: PaintSamples, model: FitModel, z: Array, covariance: Array
) -> Paints:
    outside, inside = model.surface_of(z)
    errors = _relative_errors(samples, model.prior, covariance)
    return Paints(
        samples.paints,
        samples.wavelengths,
        model.pigments(z),
        Surface(float(outside), float(inside)),
        errors,
        is_to_scale=not samples.is_opaque.all(),
    )


def _relative_errors(
    samples: PaintSamples, prior: PaintPrior, covariance: Array
) -> Pigment:
    """Return the standard errors of log K and log S, from the covariance (d, d)
    of the variables.

    Opaque samples do not change if K and S of all paints have a common factor at some
    wavelength, so that their errors are those without it.
    """
    paints, count = prior.log_scattering.shape
    size = 2 * count + 1
    root = np.linalg.cholesky(covariance)
    rows = root[: paints * size].reshape(paints, size, -1)
    unit = prior.unit_spread * root[paints * size]
    factor = STRENGTH_SPREAD * rows[:, :1] + unit
    log_S = factor + prior.scattering_root @ rows[:, 1 : count + 1]
    log_K = log_S + prior.ratio_root @ rows[:, count + 1 :]
    if samples.is_opaque.all():
        common = log_S.mean(axis=0)
        log_S = log_S - common
        log_K = log_K - common
    return Pigment(np.linalg.norm(log_K, axis=-1), np.linalg.norm(log_S, axis=-1))


def _lab(rgb: Any, sensor: Sensor) -> Any:
    """Return CIE L*a*b* (…, 3) of linear RGB, arrays of numpy or JAX."""
    return lab(rgb @ sensor.rgb_to_xyz.T, sensor.light.white)


def _packaged_guess(rgb: Array, wavelengths: Array) -> Array:
    from uplift.lookup.cube import load

    return load().reflectance(np.clip(rgb, 0, 1), wavelengths)
