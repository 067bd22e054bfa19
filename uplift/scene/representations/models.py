"""Representations by models of reflectance (TM, SG), by components of a scene (LM), and by random wavelengths (HW)."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.lights import DEFAULT_ILLUMINANT
from uplift.colorimetry.observer import END, START
from uplift.common.arrays import Array
from uplift.models import Moments, Sigmoid
from uplift.models.arithmetic import blocked_matmul
from uplift.models.duality import cosine_basis
from uplift.models.model import Model, evaluate, reflectance
from uplift.scene.representations import samples
from uplift.scene.representations.composite import spike_xyz
from uplift.scene.representations.samples import Representation

SHAPE_WEIGHT = 1e-4
"""Weight of the residual of a sigmoid at one wavelength relative to that of the colour."""
ITERATIONS = 20
FIRST_DAMPING, INCREASE, DECREASE = 1e-3, 10.0, 0.3
"""Damping of the first iteration, and its factors after a rejected and after an accepted step."""
WAVELENGTHS_PER_PATH = 4
SEED = 7
STEEPNESS, CENTRE = 0.0072, 538.0
"""Parameters of the density 1 / cosh²(0.0072 (λ − 538)), λ in nm."""


@dataclass(frozen=True, eq=False)
class TabulatedProducts(Representation):
    """Base of models of reflectance: lights and products are 5 nm tables (n, 81).

    A product evaluates the model at the 81 wavelengths of the light. It is not encoded again: no renderer does so, and
    the sigmoid could not represent it.
    """

    model: Model

    def encode_light(self, power: Array) -> Array:
        return power[:, :: samples.TABLE_STRIDE]

    def multiply(self, light: Array, surface: Array) -> Array:
        return light * reflectance(self.model, surface, observer.grid())

    def xyz(self, light: Array) -> Array:
        return light @ spike_xyz()

    def light_spectra(self, code: Array) -> Array:
        return code @ samples.hat_functions(observer.grid())

    def surface_spectra(self, code: Array) -> Array:
        return self.light_spectra(reflectance(self.model, code, observer.grid()))


class TrigonometricMoments(TabulatedProducts):
    """The zeroth moment and those above it, mirrored, as many as ``model`` has coefficients (`uplift.models.moments`).

    Peters et al. 2019, "Using moments to represent bounded signals for spectral rendering". These are the moments of
    the spectrum itself. The coefficients of cubes are fitted to colours as well (docs/materials.md).
    """

    model: Moments

    def encode_surface(self, reflectance: Array) -> Array:
        phase = self.model.phase(samples.wavelengths())
        analysis = cosine_basis(phase, self.model.count) * np.gradient(phase)[:, None] / np.pi
        analysis[:, 1:] /= 2
        analysis[[0, -1]] /= 2
        return np.asarray(blocked_matmul(reflectance, analysis))


def trigonometric_moments(count: int) -> TrigonometricMoments:
    """Trigonometric moments (TM) by ``count`` coefficients."""
    return TrigonometricMoments(f"TM{count}", "trigonometric moments", Moments(count))


class SigmoidCoefficients(TabulatedProducts):
    """Three coefficients (n, 3) of Jakob & Hanika 2019 per reflectance (`uplift.models.sigmoid`)."""

    model: Sigmoid

    def encode_surface(self, reflectance: Array) -> Array:
        return fit_sigmoids(self.model, reflectance[:, :: samples.TABLE_STRIDE])


def sigmoid_coefficients(count: int = 3) -> SigmoidCoefficients:
    """Sigmoid (SG), which always has 3 coefficients."""
    return SigmoidCoefficients(f"SG{count}", "sigmoid", Sigmoid())


def fit_sigmoids(model: Sigmoid, table: Array) -> Array:
    """Fit coefficients (n, 3) to reflectances (n, 81) by the Levenberg–Marquardt method.

    The objective is the colour under D65. Values at 5 nm, with a small weight, determine the fit where the colour does
    not or cannot be met.
    """
    light, basis = observer.light(DEFAULT_ILLUMINANT), model.basis(observer.grid())
    measurement = np.concatenate([light.xyz / light.white[:, None], SHAPE_WEIGHT * np.eye(len(basis))])

    def residuals(coefficients: Array) -> Array:
        return (evaluate(model, coefficients, observer.grid()) - table) @ measurement.T

    coefficients = np.zeros((len(table), model.count))
    damping = np.full((len(table), 1, 1), FIRST_DAMPING)
    residual = residuals(coefficients)
    for _ in range(ITERATIONS):
        jacobian = measurement @ (model.derivative(coefficients @ basis.T)[:, :, None] * basis)
        gram = jacobian.mT @ jacobian
        scale = damping * np.einsum("nii->ni", gram)[:, :, None] * np.eye(model.count)
        trial = coefficients - np.linalg.solve(gram + scale, jacobian.mT @ residual[:, :, None])[:, :, 0]
        trial_residual = residuals(trial)
        accepted = (trial_residual**2).sum(axis=1) < (residual**2).sum(axis=1)
        coefficients[accepted], residual[accepted] = trial[accepted], trial_residual[accepted]
        damping *= np.where(accepted, DECREASE, INCREASE)[:, None, None]
    return coefficients


@dataclass(frozen=True, eq=False)
class LinearModel(Representation):
    """Coordinates in an orthonormal ``basis`` (401, n): a light is n of them, a surface an n × n matrix.

    Peercy 1993, "Linear color representations for full speed spectral rendering". Spectra that the basis was not made
    from have larger errors. Kment 2011, section 5.4, omits linear models because they need this prior knowledge.
    """

    basis: Array

    def encode_light(self, power: Array) -> Array:
        return power @ self.basis

    def encode_surface(self, reflectance: Array) -> Array:
        return np.asarray(np.einsum("ik,ni,il->nkl", self.basis, reflectance, self.basis, optimize=True))

    def multiply(self, light: Array, surface: Array) -> Array:
        return np.asarray((surface @ light[:, :, None])[:, :, 0])

    def xyz(self, light: Array) -> Array:
        return light @ (self.basis.T @ samples.xyz_weights())


def linear_model(count: int, lights: Array, surfaces: Array) -> LinearModel:
    """Linear model (LM): the first ``count`` principal components, about the origin, of a scene.

    They are those of every product of its lights (L, 401), normalised to equal Y, with its surfaces (E, 401), and of
    the lights.
    """
    scatter = np.zeros((lights.shape[1],) * 2)
    for power in lights / (lights @ samples.xyz_weights()[:, 1:2]):
        radiance = np.concatenate([surfaces * power, power[None]])
        scatter += radiance.T @ radiance
    _, vectors = np.linalg.eigh(scatter)
    return LinearModel(f"LM{count}", "linear model (PCA)", vectors[:, ::-1][:, :count])


class PathSamples(NamedTuple):
    """Values (n, K) at wavelengths (n, K) nm."""

    wavelengths: Array
    values: Array


@dataclass(frozen=True, eq=False)
class HeroWavelengths(Representation):
    """Monte Carlo sampling with ``paths`` per pixel, of four wavelengths each.

    Wilkie, Nawaz, Droske, Weidlich & Hanika 2014, "Hero wavelength spectral sampling": a hero, and three more at
    distances of a quarter of the range. They follow the density of Radziszewski, Boryczko & Alda 2009, as in pbrt. The
    heroes of a pixel are stratified: one in each of as many equal strata as it has paths. A row is a pixel with its
    own, reproducible random numbers. Spectra remain tables, evaluated at the wavelengths of a path.
    """

    paths: int

    def encode_light(self, power: Array) -> PathSamples:
        drawn = self.wavelengths(len(power))
        return PathSamples(drawn, interp_rows(power, drawn))

    def multiply(self, light: PathSamples, surface: PathSamples) -> PathSamples:
        return PathSamples(light.wavelengths, light.values * surface.values)

    def xyz(self, light: PathSamples) -> Array:
        low, high = _cumulative(np.array([START, END]))
        density = STEEPNESS / np.cosh(STEEPNESS * (light.wavelengths - CENTRE)) ** 2 / (high - low)
        estimate = light.values / density
        rows = np.broadcast_to(samples.xyz_weights().T[:, None], (3, len(estimate), len(samples.xyz_weights())))
        weights = [interp_rows(row, light.wavelengths) for row in rows]
        return np.stack([(estimate * weight).mean(axis=1) for weight in weights], axis=1)

    def storage(self, code: PathSamples) -> Array:
        return super().storage(code.values)

    def wavelengths(self, pixels: int) -> Array:
        """Draw wavelengths (pixels, 4 · paths) in nm."""
        rng = np.random.default_rng(SEED)
        heroes = (np.arange(self.paths) + rng.random((pixels, self.paths))) / self.paths
        rotated = (heroes[:, :, None] + np.arange(WAVELENGTHS_PER_PATH) / WAVELENGTHS_PER_PATH) % 1
        low, high = _cumulative(np.array([START, END]))
        drawn = CENTRE + np.arctanh(low + (high - low) * rotated) / STEEPNESS
        return np.asarray(np.clip(drawn, START, END).reshape(pixels, -1))


def hero_wavelengths(paths: int) -> HeroWavelengths:
    """Hero wavelengths (HW) with ``paths`` per pixel."""
    return HeroWavelengths(f"HW{WAVELENGTHS_PER_PATH * paths}", "hero wavelengths", paths)


def interp_rows(spectra: Array, points: Array) -> Array:
    """Values (n, K) of dense spectra (n, 401), each at its own ``points`` (n, K) nm, linear between samples."""
    position = (points - observer.START) / samples.STEP
    left = np.clip(position.astype(np.intp), 0, spectra.shape[1] - 2)
    before, after = (np.take_along_axis(spectra, index, axis=1) for index in (left, left + 1))
    return np.asarray(before + (position - left) * (after - before))


def _cumulative(at: Array) -> Array:
    """Antiderivative of the density, not normalised."""
    return np.tanh(STEEPNESS * (at - CENTRE))
