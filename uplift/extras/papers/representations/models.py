"""Representations by models of reflectance (TM, SG), by components of a scene (LM), and
by random wavelengths (HW).
"""

from collections.abc import Callable

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.illuminants import DEFAULT_ILLUMINANT
from uplift.common.arrays import Array, Indices
from uplift.common.errors import OptionError
from uplift.extras.papers.representations import samples
from uplift.extras.papers.representations.composite import spike_xyz
from uplift.extras.papers.representations.samples import Representation
from uplift.models.arithmetic import blocked_matmul
from uplift.models.duality import cosine_basis
from uplift.models.least_squares import least_squares
from uplift.models.model import Model, evaluate, reflectance
from uplift.models.moments import Moments
from uplift.models.sigmoid import Sigmoid

SHAPE_WEIGHT = 1e-4
"""Weight of the residual of a sigmoid at one wavelength relative to that of the colour.
"""
MAX_STEPS = 60
WAVELENGTHS_PER_PATH = 4
SEED = 7
STEEPNESS = 0.0072
"""Steepness per nm of the density 1 / cosh²(0.0072 (λ − 538)), λ in nm."""
CENTRE = 538.0
"""Its centre in nm."""


def tabulated(
    name: str, family: str, model: Model, encode: Callable[[Array], Array]
) -> Representation:
    """Representation by a model of reflectance: lights and products are 5 nm tables (n,
    81).

    A product evaluates the model at the 81 wavelengths of the light. It is not encoded
    again: no renderer does so, and the sigmoid could not represent it.
    """
    table = observer.grid()
    hats = samples.hat_functions(table)
    return Representation(
        name,
        family,
        lambda power: power[:, :: samples.TABLE_STRIDE],
        encode,
        lambda light: light @ spike_xyz(),
        lambda light, surface: light * reflectance(model, surface, table),
        decode_light=lambda code: code @ hats,
        decode_surface=lambda code: reflectance(model, code, table) @ hats,
    )


def trigonometric_moments(count: int) -> Representation:
    """Trigonometric moments (TM): the zeroth and those above it, mirrored, as many as a
    cube has coefficients.

    Peters et al. 2019, "Using moments to represent bounded signals for spectral
    rendering". These are the moments of the spectrum itself. The coefficients of cubes
    are fitted to colours as well (docs/mathematics.md, 6).
    """
    model = Moments(count)
    phase = model.phase(samples.wavelengths())
    analysis = cosine_basis(phase, count) * np.gradient(phase)[:, None] / np.pi
    analysis[:, 1:] /= 2
    analysis[[0, -1]] /= 2
    return tabulated(
        f"TM{count}",
        "trigonometric moments",
        model,
        lambda spectra: blocked_matmul(spectra, analysis),
    )


def sigmoid_coefficients(count: int = 3) -> Representation:
    """Sigmoid (SG): the three coefficients of Jakob & Hanika 2019
    (`uplift.models.sigmoid`).
    """
    return tabulated(f"SG{count}", "sigmoid", Sigmoid(), fit_sigmoids)


def fit_sigmoids(spectra: Array) -> Array:
    """Fit coefficients (n, 3) to reflectances (n, 401) by the Levenberg–Marquardt
    method.

    The objective is the colour under D65. Values at 5 nm, with a small weight,
    determine the fit where the colour does not or cannot be met.
    """
    model = Sigmoid()
    table = spectra[:, :: samples.TABLE_STRIDE]
    light = observer.light(DEFAULT_ILLUMINANT)
    basis = model.basis(observer.grid())
    measurement = np.concatenate(
        [light.xyz / light.white[:, None], SHAPE_WEIGHT * np.eye(len(basis))]
    )

    def residuals(coefficients: Array, rows: Indices) -> Array:
        spectra = evaluate(model, coefficients, observer.grid())
        return (spectra - table[rows]) @ measurement.T

    def normal_equations(
        coefficients: Array, residuals: Array, rows: Indices
    ) -> tuple[Array, Array]:
        jacobian = measurement @ (
            model.derivative(coefficients @ basis.T)[:, :, None] * basis
        )
        return jacobian.mT @ jacobian, (jacobian.mT @ residuals[..., None])[..., 0]

    start = np.zeros((len(table), model.count))
    return least_squares(residuals, normal_equations, start, max_steps=MAX_STEPS)


def principal_components(count: int, lights: Array, surfaces: Array) -> Array:
    """First ``count`` principal components (401, count), about the origin, of a scene.

    They are those of every product of its lights (L, 401), normalised to equal Y, with
    its surfaces (E, 401), and of the lights.
    """
    scatter = np.zeros((lights.shape[1],) * 2)
    for power in lights / (lights @ samples.xyz_weights()[:, 1:2]):
        radiance = np.concatenate([surfaces * power, power[None]])
        scatter += radiance.T @ radiance
    return np.linalg.eigh(scatter)[1][:, ::-1][:, :count]


def linear_model(count: int, lights: Array, surfaces: Array) -> Representation:
    """Linear model (LM): coordinates in `principal_components`. A light is n of them, a
    surface an n × n matrix.

    Peercy 1993, "Linear color representations for full speed spectral rendering".
    Spectra that the basis was not made from have larger errors. Kment 2011, section
    5.4, omits linear models because they need this prior knowledge.
    """
    basis = principal_components(count, lights, surfaces)
    return Representation(
        f"LM{count}",
        "linear model (PCA)",
        lambda power: power @ basis,
        lambda surface: np.einsum(
            "ik,ni,il->nkl", basis, surface, basis, optimize=True
        ),
        lambda light: light @ (basis.T @ samples.xyz_weights()),
        lambda light, surface: (surface @ light[:, :, None])[:, :, 0],
    )


def hero_wavelengths(count: int) -> Representation:
    """Hero wavelengths (HW): Monte Carlo sampling with ``count`` wavelengths per pixel,
    in paths of four each.

    Wilkie, Nawaz, Droske, Weidlich & Hanika 2014, "Hero wavelength spectral sampling":
    a hero, and three more at distances of a quarter of the range. They follow the
    density of Radziszewski, Boryczko & Alda 2009, as in pbrt. The heroes of a pixel are
    stratified: one in each of as many equal strata as it has paths. A row is a pixel
    with its own, reproducible random numbers. Spectra remain tables, evaluated at the
    wavelengths of a path. Raises `OptionError` unless the count is a multiple of four.
    """
    paths, remainder = divmod(count, WAVELENGTHS_PER_PATH)
    if remainder or not paths:
        raise OptionError(
            "number of hero wavelengths must be a positive multiple of four, got "
            f"{count}"
        )
    low, high = np.tanh(STEEPNESS * (np.array([observer.START, observer.END]) - CENTRE))

    def draw(pixels: int) -> Array:
        """Wavelengths (pixels, 4 · paths) in nm, by the inverse of the density's
        antiderivative.
        """
        rng = np.random.default_rng(SEED)
        heroes = (np.arange(paths) + rng.random((pixels, paths))) / paths
        rotated = (
            heroes[:, :, None] + np.arange(WAVELENGTHS_PER_PATH) / WAVELENGTHS_PER_PATH
        ) % 1
        drawn = CENTRE + np.arctanh(low + (high - low) * rotated) / STEEPNESS
        return np.clip(drawn, observer.START, observer.END).reshape(pixels, -1)

    def encode(spectra: Array) -> Array:
        pairs = zip(draw(len(spectra)), spectra, strict=True)
        return np.stack(
            [np.interp(at, samples.wavelengths(), row) for at, row in pairs]
        )

    def xyz(light: Array) -> Array:
        drawn = draw(len(light))
        estimate = (
            light
            * np.cosh(STEEPNESS * (drawn - CENTRE)) ** 2
            * (high - low)
            / STEEPNESS
        )
        weights = (
            np.interp(drawn, samples.wavelengths(), column)
            for column in samples.xyz_weights().T
        )
        return np.stack(
            [(estimate * weight).mean(axis=1) for weight in weights], axis=1
        )

    return Representation(f"HW{count}", "hero wavelengths", encode, encode, xyz)
