"""Spectral representations for renderers, each a subclass of `Representation`, and their registry.

References
----------
Kment 2011, "Spectral data representation techniques for realistic image synthesis", thesis, Vienna. Abbreviations,
sections and equations in this package refer to it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from uplift.common.arrays import Array
from uplift.scene.representations.composite import enhanced_riemann, sun_composite
from uplift.scene.representations.filters import mitchell_point_samples
from uplift.scene.representations.models import (
    hero_wavelengths,
    linear_model,
    sigmoid_coefficients,
    trigonometric_moments,
)
from uplift.scene.representations.samples import Representation, gauss_samples, point_samples, riemann_sums

__all__ = ["COMPONENTS", "FACTORIES", "Representation", "all_representations"]

SIZES = (4, 8, 16, 32)
"""Numbers of samples."""
COMPONENTS = (4, 8, 16)
"""Numbers of components of the linear model."""

FACTORIES: Mapping[str, tuple[Callable[[int], Representation], tuple[int, ...]]] = {
    "PS": (point_samples, SIZES),
    "PF": (mitchell_point_samples, SIZES),
    "RS": (riemann_sums, SIZES),
    "RE": (enhanced_riemann, SIZES),
    "CS": (sun_composite, (5, 7, 11, 15)),  # Fourier coefficients in the thesis
    "GQ": (gauss_samples, SIZES),
    "TM": (trigonometric_moments, (5, 9, 13, 17)),  # moments that cubes may store
    "SG": (sigmoid_coefficients, (3,)),
    "HW": (hero_wavelengths, (1, 4, 16, 64)),  # paths per pixel
}
"""Factory and sizes by abbreviation. The linear model (LM) is not included, as it depends on the scene."""


def all_representations(lights: Array, surfaces: Array) -> tuple[Representation, ...]:
    """Every registered representation, and the linear models of a scene of lights (L, 401) and surfaces (E, 401)."""
    registered = (make(size) for make, sizes in FACTORIES.values() for size in sizes)
    return (*registered, *(linear_model(count, lights, surfaces) for count in COMPONENTS))
