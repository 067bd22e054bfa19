"""The one place that reads colour-science's tables: observers, illuminants and RGB spaces by name."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Mapping
from types import ModuleType
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import Primaries
from uplift.colorimetry.lights import DEFAULT_ILLUMINANT
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array
from uplift.common.errors import unknown_name

DEFAULT_OBSERVER = "CIE 1931 2 Degree Standard Observer"
CRT = "Typical CRT Brainard 1997"
"""A cathode-ray tube's phosphors, as D. H. Brainard measured them."""
START, END, STEP = 380.0, 780.0, 5.0
"""Where every table of the CIE has data (nm)."""


@functools.cache
def colour_science() -> ModuleType:
    """colour-science, imported when first needed (a second) and silent about its optional parts.

    It sets how numpy prints; that is set back.
    """
    with warnings.catch_warnings(), np.printoptions():
        warnings.simplefilter("ignore")
        import colour
    return colour


def grid() -> Array:
    """(81,) wavelengths of every sensor: 380–780 nm at 5 nm."""
    return np.arange(START, END + STEP / 2, STEP)


def sensor(
    space: str = "sRGB", illuminant: str = DEFAULT_ILLUMINANT, observer: str = DEFAULT_OBSERVER
) -> Sensor:
    """A sensor by names of colour-science.

    The illuminant's white is taken to the space's white by Bradford adaptation, and each row is scaled
    so that the perfect reflector gives (1, 1, 1) to the last bit that counts.

    Raises
    ------
    UnknownNameError : with the nearest name that exists.
    """
    colour = colour_science()
    rgb_space = _look_up(colour.RGB_COLOURSPACES, space, "RGB space")
    lit = light(illuminant, observer)
    white = colour.xy_to_XYZ(rgb_space.whitepoint)
    adapt = colour.adaptation.matrix_chromatic_adaptation_VonKries(lit.white, white, transform="Bradford")
    matrix = rgb_space.matrix_XYZ_to_RGB @ adapt
    return Sensor(
        space=rgb_space.name,
        illuminant=lit.name,
        observer=_look_up(colour.MSDS_CMFS, observer, "observer").name,
        wavelengths=grid(),
        cmfs=matching_functions(observer),
        power=illuminant_spd(illuminant),
        xyz_to_rgb=matrix / (matrix @ lit.white)[:, None],
        decoding=np.asarray(rgb_space.cctf_decoding(np.arange(256) / 255), dtype=float),
    )


def primaries(space: str) -> Primaries:
    """Primaries and white of an RGB space by name. Raises `UnknownNameError`."""
    found = _look_up(colour_science().RGB_COLOURSPACES, space, "RGB space")
    return Primaries.of([*found.primaries.ravel(), *found.whitepoint])


def light(illuminant: str, observer: str = DEFAULT_OBSERVER) -> Light:
    """An illuminant to look under, on the grid of every sensor. Raises `UnknownNameError`."""
    colour = colour_science()
    weights = matching_functions(observer) * illuminant_spd(illuminant)[:, None]
    return Light(
        _look_up(colour.SDS_ILLUMINANTS, illuminant, "illuminant").name, (weights / weights[:, 1].sum()).T
    )


def aligned(sensor: Sensor, start: float = START, end: float = END, step: float = STEP) -> tuple[Any, Any]:
    """A sensor's observer and illuminant as colour-science's own objects, from ``start`` to ``end`` nm."""
    colour = colour_science()
    shape = colour.SpectralShape(start, end, step)
    cmfs, light = colour.MSDS_CMFS[sensor.observer], colour.SDS_ILLUMINANTS[sensor.illuminant]
    return cmfs.copy().align(shape), light.copy().align(shape)


def axis_nodes(spacing: str, dim: int) -> Array:
    """(dim,) linear RGB positions of the nodes of a lattice axis, from 0 to 1, spaced as ``spacing`` says."""
    even = np.linspace(0.0, 1.0, dim)
    if spacing == "linear":
        return even
    if spacing == "srgb":
        return np.asarray(colour_science().models.eotf_sRGB(even), dtype=float)
    raise unknown_name(spacing, ("srgb", "linear"), "axis spacing")


def _look_up(table: Mapping[str, Any], name: str, kind: str) -> Any:
    try:
        return table[name]
    except KeyError:
        raise unknown_name(name, table, kind) from None


def matching_functions(
    observer: str = DEFAULT_OBSERVER, start: float = START, end: float = END, step: float = STEP
) -> Array:
    """(N, 3) colour-matching functions from ``start`` to ``end`` nm. Raises `UnknownNameError`."""
    return _samples(colour_science().MSDS_CMFS, observer, "observer", (start, end, step))


def illuminant_spd(illuminant: str, start: float = START, end: float = END, step: float = STEP) -> Array:
    """(N,) relative spectral power from ``start`` to ``end`` nm. Raises `UnknownNameError`."""
    return _samples(colour_science().SDS_ILLUMINANTS, illuminant, "illuminant", (start, end, step))


def display_primaries(
    display: str = CRT, start: float = START, end: float = END, step: float = STEP
) -> Array:
    """(N, 3) relative power of a display's red, green and blue. Raises `UnknownNameError`."""
    return _samples(colour_science().MSDS_DISPLAY_PRIMARIES, display, "display", (start, end, step))


def _samples(
    table: Mapping[str, Any], name: str, kind: str, shape: tuple[float, float, float] = (START, END, STEP)
) -> Array:
    """Samples of a colour-science table; outside its data held flat, as colour-science aligns."""
    shape = colour_science().SpectralShape(*shape)
    return np.asarray(_look_up(table, name, kind).copy().align(shape).values, dtype=float)
