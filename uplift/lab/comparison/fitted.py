"""Representations that are fitted to a scene: wavelengths, Bergner's factor model, and moments as cubes have them."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain

import numpy as np

from uplift.colorimetry import Sensor, observer
from uplift.common.arrays import Array, Indices
from uplift.design.palette.factor import FactorModel, factor_model
from uplift.fit.entries import fit_entries
from uplift.fit.problem import Problem
from uplift.lab.comparison.compare import Scene
from uplift.models import Moments
from uplift.scene.representations import Representation, all_representations, samples
from uplift.scene.representations.models import TrigonometricMoments
from uplift.scene.wavelengths import Sampling, choose, make_setup

WAVELENGTHS, FACTORS, MOMENTS = (5, 7, 9, 12), (5, 7, 9), (9, 13, 17)
STRIDE = 40
"""Dense samples between those by which a spectrum is recognised."""


@dataclass(frozen=True, eq=False)
class FittedWavelengths(Representation):
    """Wavelengths, weights, and powers of known lights (L, 401), as `uplift.scene.wavelengths` fits them together."""

    sampling: Sampling
    lights: Array

    def encode_light(self, power: Array) -> Array:
        return self.sampling.powers[nearest_rows(power, self.lights)]

    def encode_surface(self, reflectance: Array) -> Array:
        return np.asarray(reflectance @ samples.interpolation_matrix(self.sampling.wavelengths))

    def multiply(self, light: Array, surface: Array) -> Array:
        return light * surface

    def xyz(self, light: Array) -> Array:
        return light @ self.sampling.to_xyz


@dataclass(frozen=True, eq=False)
class FactorCoefficients(Representation):
    """Coefficients of a factor model for the RGB space of a sensor (Bergner, Möller & Drew 2004)."""

    model: FactorModel
    sensor: Sensor

    def encode_light(self, power: Array) -> Array:
        return self.model.light(power[:, :: samples.TABLE_STRIDE])

    def encode_surface(self, reflectance: Array) -> Array:
        return self.model.reflectance(reflectance[:, :: samples.TABLE_STRIDE])

    def multiply(self, light: Array, surface: Array) -> Array:
        return self.model.product(light, surface)

    def xyz(self, light: Array) -> Array:
        return self.model.rgb(light) @ np.linalg.inv(self.sensor.xyz_to_rgb).T


@dataclass(frozen=True, eq=False)
class CubeMoments(TrigonometricMoments):
    """Moments (E, C) of known surfaces (E, 401), fitted to their spectra, their colours under the lights, and RGB."""

    surfaces: Array
    moments: Array

    def encode_surface(self, reflectance: Array) -> Array:
        return self.moments[nearest_rows(reflectance, self.surfaces)]


def nearest_rows(spectra: Array, known: Array) -> Indices:
    """Rows (n,) of the known spectra (k, 401) that spectra (n, 401) are."""
    difference = spectra[:, None, ::STRIDE] - known[:, ::STRIDE]
    return np.asarray((difference**2).sum(axis=-1).argmin(axis=1))


def scene_representations(scene: Scene) -> tuple[Representation, ...]:
    """Every registered representation, and those that are fitted to a scene."""
    registered = all_representations(scene.powers, scene.surfaces)
    return (*registered, *chain(_wavelengths(scene), _factors(scene), _moments(scene)))


def _wavelengths(scene: Scene) -> Iterator[Representation]:
    names = [name for light_set in scene.sets for name in light_set.lights]
    setup = make_setup(scene.surfaces, names, wavelengths=samples.wavelengths())
    for count in WAVELENGTHS:
        sampling = choose(setup, count=count).sampling
        yield FittedWavelengths(f"FW{count}", "fitted wavelengths", sampling, scene.powers)


def _factors(scene: Scene) -> Iterator[Representation]:
    sensor, step = observer.sensor(), samples.TABLE_STRIDE
    for count in FACTORS:
        model = factor_model(sensor, scene.surfaces[:, ::step], scene.powers[:, ::step], count)
        yield FactorCoefficients(f"BF{count}", "factor model", model, sensor)


def _moments(scene: Scene) -> Iterator[Representation]:
    sensor = observer.sensor()
    lights = tuple(observer.light(name) for light_set in scene.sets for name in light_set.lights)
    measured = scene.surfaces[:, :: samples.TABLE_STRIDE]
    for count in MOMENTS:
        model = Moments(count)
        fitted = fit_entries(Problem(sensor, model, lights), measured, sensor.rgb(measured))
        stored = model.to_storage(fitted.multipliers)
        yield CubeMoments(f"CM{count}", "moments of cubes", model, scene.surfaces, stored)
