"""Every representation that is compared, in the order of the thesis, then those of today."""

from __future__ import annotations

from typing import Any

from uplift.common.arrays import Array
from uplift.scene.representations.composite import enhanced_riemann, sun_composite
from uplift.scene.representations.gauss_quadrature import gauss_samples
from uplift.scene.representations.hero_wavelengths import HeroWavelengths
from uplift.scene.representations.linear_model import linear_model
from uplift.scene.representations.point_sampling import mitchell_point_samples, point_samples
from uplift.scene.representations.representation import Representation
from uplift.scene.representations.riemann_sums import riemann_sums
from uplift.scene.representations.sigmoid import SigmoidCoefficients
from uplift.scene.representations.trigonometric_moments import trigonometric_moments

SIZES = (4, 8, 16, 32)
COEFFICIENTS = (5, 7, 11, 15)
"""Of Sun's composite model, as the thesis has them."""
MOMENTS = (5, 9, 13, 17)
"""What cubes may hold."""
COMPONENTS = (4, 8, 16)
PATHS = (1, 4, 16, 64)


def all_representations(lights: Array, surfaces: Array) -> tuple[Representation, ...]:
    """All, for a scene of lights (L, 401) and surfaces (E, 401), which the linear models are made from."""
    found: list[Any] = [
        make(count)
        for make in (point_samples, mitchell_point_samples, riemann_sums, enhanced_riemann)
        for count in SIZES
    ]
    found += [sun_composite(count) for count in COEFFICIENTS]
    found += [gauss_samples(count) for count in SIZES]
    found += [trigonometric_moments(count) for count in MOMENTS]
    found += [SigmoidCoefficients()]
    found += [linear_model(count, lights, surfaces) for count in COMPONENTS]
    return (*found, *(HeroWavelengths(paths) for paths in PATHS))
