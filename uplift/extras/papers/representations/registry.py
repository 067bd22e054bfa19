"""Registry of the representations, by abbreviation and by name."""

import math
from collections.abc import Callable, Mapping

from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.text import format_value, parse_float, parse_whole
from uplift.extras.papers.representations import (
    composite,
    filters,
    models,
    samples,
)
from uplift.extras.papers.representations.samples import Representation

SIZES = (4, 8, 16, 32)
"""Numbers of samples."""
MAX_SIZE = 401
"""Largest number of samples of a representation that is given by its name: that of
dense spectra.
"""
COMPONENTS = (4, 8, 16)
"""Numbers of components of the linear model."""

FACTORIES: Mapping[str, tuple[Callable[[int], Representation], tuple[int, ...]]] = {
    "PS": (samples.point_samples, SIZES),
    "PF": (filters.mitchell_point_samples, SIZES),
    "RS": (samples.riemann_sums, SIZES),
    "RE": (composite.enhanced_riemann, SIZES),
    # Fourier coefficients in the thesis
    "CS": (composite.sun_composite, (5, 7, 11, 15)),
    "GQ": (samples.gauss_samples, SIZES),
    # moments that cubes may store
    "TM": (models.trigonometric_moments, (5, 9, 13, 17)),
    "SG": (models.sigmoid_coefficients, (3,)),
    "HW": (models.hero_wavelengths, (4, 16, 64, 256)),  # wavelengths per pixel
}
"""Factory and sizes by abbreviation. The linear model (LM) is not included, as it
depends on the scene.
"""


def all_representations(lights: Array, surfaces: Array) -> tuple[Representation, ...]:
    """Every registered representation, and the linear models of a scene of lights (L,
    401) and surfaces (E, 401).
    """
    registered = list[Representation]()
    for make, sizes in FACTORIES.values():
        registered += map(make, sizes)
    linear = [models.linear_model(count, lights, surfaces) for count in COMPONENTS]
    return (*registered, *linear)


def find_representation(text: str) -> Representation:
    """Return the representation of a name such as ``PF16``, or of
    ``PS16:KIND:EXTENT:PARAMETERS``, with a filter.

    The kinds and parameters of filters are those of `filters.KINDS`. Raises
    `OptionError`.
    """
    name, *low_pass = text.split(":")
    try:
        make, sizes = FACTORIES[name[:2]]
        count = parse_whole(name[2:])
        if not 2 <= count <= MAX_SIZE or (len(sizes) == 1 and count not in sizes):
            raise ValueError
        if not low_pass:
            return make(count)
        kind, extent, *parameters = low_pass
        values = tuple(map(parse_float, parameters))
        is_filter = parse_whole(extent) in filters.EXTENTS and len(values) == len(
            filters.KINDS[kind].choices
        )
        if name[:2] != "PS" or not is_filter or not all(map(math.isfinite, values)):
            raise ValueError
        low_pass_filter = filters.Filter(kind, int(extent), values)
        return filters.filtered_point_samples(count, low_pass_filter)
    except (KeyError, ValueError) as error:
        hint = (
            "write for example PF16, RS32 or TM9; a filter as PS16:gaussian:7:0.5, "
            "with an odd extent from 3 to 21"
        )
        raise OptionError(
            f"unknown representation {format_value(text)}", hint=hint
        ) from error
