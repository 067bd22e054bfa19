"""Representations that are fitted to a scene: wavelengths, Bergner's factor model, and
moments as cubes have them.
"""

from collections.abc import Iterator
from functools import partial

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.extras.papers.palette.factor import factor_model
from uplift.extras.papers.representations import samples
from uplift.extras.papers.representations.compare import Scene
from uplift.extras.papers.representations.models import tabulated
from uplift.extras.papers.representations.registry import all_representations
from uplift.extras.papers.representations.samples import Representation
from uplift.extras.papers.wavelengths.choice import choose
from uplift.extras.papers.wavelengths.sampling import make_setup
from uplift.fit.entries import fit_entries
from uplift.fit.problem import Problem
from uplift.models.moments import Moments

WAVELENGTHS = (5, 7, 9, 12)
FACTORS = (5, 7, 9)
MOMENTS = (9, 13, 17)
STRIDE = 40
"""Dense samples between those by which a spectrum is recognised."""


def _known_rows(known: Array, codes: Array, spectra: Array) -> Array:
    """Codes (n, C) of spectra (n, 401), from those (k, C) of the known spectra (k, 401)
    that they are.
    """
    difference = spectra[:, None, ::STRIDE] - known[:, ::STRIDE]
    return codes[(difference**2).sum(axis=-1).argmin(axis=1)]


def scene_representations(scene: Scene) -> tuple[Representation, ...]:
    """Every registered representation, and those that are fitted to a scene."""
    registered = all_representations(scene.powers, scene.surfaces)
    return (*registered, *_wavelengths(scene), *_factors(scene), *_moments(scene))


def _wavelengths(scene: Scene) -> Iterator[Representation]:
    """Wavelengths, weights, and powers of the lights, as
    `uplift.extras.papers.wavelengths` fits them together.
    """
    nm = samples.wavelengths()
    setup = make_setup(scene.surfaces, scene.illuminants, wavelengths=nm)

    def of_size(count: int) -> Representation:
        sampling = choose(setup, count=count).sampling
        points = samples.interpolation_matrix(sampling.wavelengths)
        return Representation(
            f"FW{count}",
            "fitted wavelengths",
            partial(_known_rows, scene.powers, sampling.powers),
            lambda reflectance: reflectance @ points,
            lambda light: light @ sampling.to_xyz,
        )

    return map(of_size, WAVELENGTHS)


def _factors(scene: Scene) -> Iterator[Representation]:
    """Coefficients of a factor model for sRGB (Bergner, Möller & Drew 2004)."""
    sensor = observer.sensor()
    step = samples.TABLE_STRIDE

    def of_size(count: int) -> Representation:
        model = factor_model(
            sensor, scene.surfaces[:, ::step], scene.powers[:, ::step], count
        )
        return Representation(
            f"BF{count}",
            "factor model",
            lambda power: model.light(power[:, ::step]),
            lambda reflectance: model.reflectance(reflectance[:, ::step]),
            lambda light: model.rgb(light) @ np.linalg.inv(sensor.xyz_to_rgb).T,
            model.product,
        )

    return map(of_size, FACTORS)


def _moments(scene: Scene) -> Iterator[Representation]:
    """Moments of the surfaces, fitted to their spectra, their colours under the lights,
    and RGB.
    """
    sensor = observer.sensor()
    lights = tuple(map(observer.light, scene.illuminants))
    measured = scene.surfaces[:, :: samples.TABLE_STRIDE]
    for count in MOMENTS:
        model = Moments(count)
        problem = Problem(sensor, model, lights)
        fitted = fit_entries(problem, measured, sensor.rgb(measured))
        codes = model.to_storage(fitted.multipliers)
        encode = partial(_known_rows, scene.surfaces, codes)
        yield tabulated(f"CM{count}", "moments of cubes", model, encode)
