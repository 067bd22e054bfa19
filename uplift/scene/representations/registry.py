"""Every representation that is compared, in the order of the thesis, then those of today."""

from __future__ import annotations

from typing import Any

from uplift.common.arrays import Array
from uplift.scene.representations.composite import enhanced, sun
from uplift.scene.representations.hero import Hero
from uplift.scene.representations.linear import linear
from uplift.scene.representations.moments import moments
from uplift.scene.representations.point import point, prefiltered
from uplift.scene.representations.quadrature import quadrature
from uplift.scene.representations.representation import Representation
from uplift.scene.representations.riemann import riemann
from uplift.scene.representations.sigmoid import SigmoidCurve

SIZES = (4, 8, 16, 32)
COEFFICIENTS = (5, 7, 11, 15)
"""Of Sun's composite model, as the thesis has them."""
MOMENTS = (5, 9, 13, 17)
"""What cubes may hold."""
COMPONENTS = (4, 8, 16)
PATHS = (1, 4, 16, 64)


def representations(lights: Array, surfaces: Array) -> tuple[Representation, ...]:
    """All, for a scene of lights (L, 401) and surfaces (E, 401), which the linear models are made from."""
    found: list[Any] = [make(count) for make in (point, prefiltered, riemann, enhanced) for count in SIZES]
    found += [sun(count) for count in COEFFICIENTS]
    found += [quadrature(count) for count in SIZES]
    found += [moments(count) for count in MOMENTS]
    found += [SigmoidCurve()]
    found += [linear(count, lights, surfaces) for count in COMPONENTS]
    return (*found, *(Hero(paths) for paths in PATHS))
