"""Sensors, lights and observers by name, from the tables of colour-science.

Tables are sampled from ``start`` to ``end`` every ``step`` nm; outside their range values are extrapolated as constant.
Names that are unknown raise `UnknownNameError`, whose hint gives the nearest ones.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.camera import CAMERA, Camera, camera_sensor, read_camera
from uplift.colorimetry.gamut import Primaries
from uplift.colorimetry.lights import DEFAULT_ILLUMINANT, Lamps
from uplift.colorimetry.sensor import Light, Sensor
from uplift.colorimetry.spaces import look_up_space
from uplift.colorimetry.srgb import decode_portably
from uplift.common.arrays import Array
from uplift.common.colour_science import colour_science
from uplift.common.errors import OptionError, unknown_name

DEFAULT_OBSERVER = "CIE 1931 2 Degree Standard Observer"
CRT = "Typical CRT Brainard 1997"
"""Phosphors of a cathode-ray tube, measured by D. H. Brainard."""
COMMON_SPACES = ("sRGB", "Display P3", "ITU-R BT.2020", "ACEScg", "ProPhoto RGB")
"""Names of colour-science, by the area of the gamut in CIE 1976 u′, v′."""
LAMP_TABLES = ("SDS_ILLUMINANTS", "SDS_LIGHT_SOURCES")
VISIBLE = (400.0, 700.0)
"""Range in nm that a lamp must cover."""
SAME_LAMP = 1e-3
"""Difference, as a share of the largest power, below which two lamps are one."""
START, END, STEP = 380.0, 780.0, 5.0
"""Range and step in nm that every table of the CIE covers."""


def grid() -> Array:
    """Return the wavelengths of every sensor, shape (81,): 380–780 nm at 5 nm."""
    return np.arange(START, END + STEP / 2, STEP)


def sensor(
    space: str = "sRGB", illuminant: str = DEFAULT_ILLUMINANT, observer: str | Camera = DEFAULT_OBSERVER
) -> Sensor:
    """Create a sensor from names of colour-science.

    Bradford adaptation takes the white of the illuminant to the white of the space. Each row of the matrix is scaled
    so that the perfect reflector gives (1, 1, 1) to the last significant bit.

    Parameters
    ----------
    space : str
        RGB space: a name of colour-science, a short name such as ``AP1``, or a name of OpenColorIO, such as
        ``lin_rec2020``, of a space that colour-science has as well. ``"camera"`` are raw values of a camera.
    illuminant : str
        Illuminant that the RGB refer to.
    observer : str or Camera
        Colour-matching functions; for the space ``"camera"`` a camera, see `find_camera`. XYZ of a camera's sensor are
        those of the CIE 1931 observer.

    Returns
    -------
    Sensor

    Raises
    ------
    UnknownNameError
        A name is unknown; the hint gives the nearest names.
    OptionError
        A camera without its space (``camera-without-space``), or one that cannot be used; see `Camera`.

    Examples
    --------
    >>> import numpy as np
    >>> sensor("sRGB").rgb(np.full(81, 0.5)).round(12).tolist()
    [0.5, 0.5, 0.5]
    """
    if space == CAMERA:
        camera = find_camera(observer)
        if camera.name in colour_science().RGB_COLOURSPACES:
            raise OptionError(f"a camera must not have the name of an RGB space, got '{camera.name}'")
        standard = (DEFAULT_OBSERVER, matching_functions())
        return camera_sensor(camera, grid(), light(illuminant), illuminant_spd(illuminant), *standard)
    colour = colour_science()
    if isinstance(observer, Camera) or observer in colour.MSDS_CAMERA_SENSITIVITIES:
        raise OptionError(
            "a camera in place of an observer has its own RGB space",
            code="camera-without-space",
            hint=f'use space="{CAMERA}"',
        )
    rgb_space = look_up_space(space)
    build_light = light(illuminant, observer)
    white = colour.xy_to_XYZ(rgb_space.whitepoint)
    adapt = colour.adaptation.matrix_chromatic_adaptation_VonKries(build_light.white, white, transform="Bradford")
    matrix = rgb_space.matrix_XYZ_to_RGB @ adapt
    return Sensor(
        space=rgb_space.name,
        illuminant=build_light.name,
        observer=_look_up(colour.MSDS_CMFS, observer, "observer").name,
        wavelengths=grid(),
        cmfs=matching_functions(observer),
        power=illuminant_spd(illuminant),
        xyz_to_rgb=matrix / (matrix @ build_light.white)[:, None],
        decoding=np.asarray(rgb_space.cctf_decoding(np.arange(256) / 255), dtype=float),
    )


def on_range(sensor: Sensor, start: float, end: float, step: float) -> Sensor:
    """Return a sensor with another range of wavelengths, where the perfect reflector is white again."""
    if sensor.range == (start, end, step):
        return sensor
    wide = light(sensor.illuminant, sensor.observer, start, end, step)
    wavelengths = np.arange(start, end + step / 2, step)
    sensitivities = None
    if sensor.sensitivities is not None:
        sensitivities = Camera(sensor.space, sensor.wavelengths, sensor.sensitivities).at(wavelengths)
    return replace(
        sensor,
        wavelengths=wavelengths,
        cmfs=matching_functions(sensor.observer, start, end, step),
        power=illuminant_spd(sensor.illuminant, start, end, step),
        xyz_to_rgb=sensor.xyz_to_rgb / (sensor.xyz_to_rgb @ wide.white)[:, None],
        sensitivities=sensitivities,
    )


def find_camera(camera: str | Camera) -> Camera:
    """Find the sensitivities of a camera."""
    if isinstance(camera, Camera):
        return camera
    if camera.casefold().endswith(".csv"):
        return read_camera(camera)
    found = _look_up(colour_science().MSDS_CAMERA_SENSITIVITIES, camera, "camera")
    return Camera(found.name, found.wavelengths, found.values)


def display_sensors(
    illuminants: Sequence[str], observer: str, start: float = START, end: float = END, step: float = STEP
) -> tuple[Sensor, ...]:
    """Create an sRGB sensor for each illuminant, without duplicates.

    Their linear RGB can be displayed directly: the white of each illuminant becomes the white of the screen.
    """
    sensors = (on_range(sensor("sRGB", name, observer), start, end, step) for name in illuminants)
    return tuple({each.illuminant: each for each in sensors}.values())


def primaries(space: str) -> Primaries:
    """Return the primaries and white of an RGB space."""
    rgb_space = look_up_space(space)
    return Primaries.of([*rgb_space.primaries.ravel(), *rgb_space.whitepoint])


def light(
    illuminant: str, observer: str = DEFAULT_OBSERVER, start: float = START, end: float = END, step: float = STEP
) -> Light:
    """Create a light, by default on the wavelengths of `grid`.

    Parameters
    ----------
    illuminant : str
        Illuminant.
    observer : str
        Colour-matching functions.
    start, end, step : float
        Range and step in nm, as `Sensor.range`.

    Returns
    -------
    Light

    Raises
    ------
    UnknownNameError
        A name is unknown.
    """
    power = illuminant_spd(illuminant, start, end, step)
    weights = matching_functions(observer, start, end, step) * power[:, None]
    name = _look_up(colour_science().SDS_ILLUMINANTS, illuminant, "illuminant").name
    return Light(name, (weights / weights[:, 1].sum()).T)


def aligned(sensor: Sensor, start: float = START, end: float = END, step: float = STEP) -> tuple[Any, Any]:
    """Return the observer and illuminant of a sensor as objects of colour-science."""
    colour = colour_science()
    shape = colour.SpectralShape(start, end, step)
    cmfs, light = colour.MSDS_CMFS[sensor.observer], colour.SDS_ILLUMINANTS[sensor.illuminant]
    return cmfs.copy().align(shape), light.copy().align(shape)


def axis_nodes(spacing: str, dim: int) -> Array:
    """Return the positions of the nodes of a lattice axis in linear RGB.

    They are the same doubles on every CPU, so cubes of one dim and spacing have equal nodes wherever they were built.

    Shape (dim,).
    """
    even = np.linspace(0.0, 1.0, dim)
    if spacing == "linear":
        return even
    if spacing == "srgb":
        return decode_portably(even)
    raise unknown_name(spacing, ("srgb", "linear"), "axis spacing")


def matching_functions(
    observer: str = DEFAULT_OBSERVER, start: float = START, end: float = END, step: float = STEP
) -> Array:
    """Return colour-matching functions. Shape (N, 3)."""
    return _samples("MSDS_CMFS", observer, "observer", start, end, step)


def illuminant_spd(illuminant: str, start: float = START, end: float = END, step: float = STEP) -> Array:
    """Return the relative spectral power of an illuminant. Shape (N,)."""
    return _samples("SDS_ILLUMINANTS", illuminant, "illuminant", start, end, step)


def lamps(observer: str = DEFAULT_OBSERVER, start: float = START, end: float = END, step: float = STEP) -> Lamps:
    """Return the lights of colour-science: CIE illuminants and measured lamps.

    Lights that are measured on less than 400–700 nm, and lights with the spectrum of an earlier one, are left out.
    """
    luminance = matching_functions(observer, start, end, step)[:, 1]
    colour = colour_science()
    names: list[str] = []
    powers: list[Array] = []
    for table in LAMP_TABLES:
        for name, found in getattr(colour, table).items():
            if found.wavelengths[0] > VISIBLE[0] or found.wavelengths[-1] < VISIBLE[1]:
                continue
            power = np.maximum(_samples(table, name, "lamp", start, end, step), 0.0)
            power = power * (luminance.sum() / (power @ luminance))
            if all(np.abs(power - other).max() > SAME_LAMP * other.max() for other in powers):
                names.append(name)
                powers.append(power)
    return Lamps(tuple(names), np.array(powers))


def display_primaries(display: str = CRT, start: float = START, end: float = END, step: float = STEP) -> Array:
    """Return the relative spectral power of the primaries of a display. Shape (N, 3)."""
    return _samples("MSDS_DISPLAY_PRIMARIES", display, "display", start, end, step)


def illuminant_names() -> tuple[str, ...]:
    """Return the names of all illuminants.

    >>> "FL11" in illuminant_names()
    True
    """
    return tuple(colour_science().SDS_ILLUMINANTS)


def observer_names() -> tuple[str, ...]:
    """Return the names of all standard observers.

    >>> DEFAULT_OBSERVER in observer_names()
    True
    """
    return tuple(colour_science().MSDS_CMFS)


def camera_names() -> tuple[str, ...]:
    """Return the names of all cameras.

    >>> camera_names()
    ('Nikon 5100 (NPL)', 'Sigma SDMerill (NPL)')
    """
    return tuple(colour_science().MSDS_CAMERA_SENSITIVITIES)


def space_names() -> tuple[str, ...]:
    """Return the names of all RGB spaces.

    >>> "sRGB" in space_names()
    True
    """
    return tuple(colour_science().RGB_COLOURSPACES)


def smallest_space(
    reflectances: ArrayLike, illuminant: str = DEFAULT_ILLUMINANT, observer: str = DEFAULT_OBSERVER
) -> str | None:
    """Find the smallest of the common RGB spaces that holds all colours of reflectances.

    Shapes: ``reflectances`` (…, N).

    >>> import numpy as np
    >>> smallest_space(np.full(81, 0.5))
    'sRGB'
    """
    for space in COMMON_SPACES:
        candidate = sensor(space, illuminant, observer)
        if candidate.contains(candidate.rgb(reflectances)).all():
            return space
    return None


def holding_note(
    reflectances: ArrayLike, illuminant: str = DEFAULT_ILLUMINANT, observer: str = DEFAULT_OBSERVER
) -> str:
    """Describe the smallest of the common RGB spaces that holds all colours of reflectances.

    Shapes: ``reflectances`` (E, N).
    """
    space = smallest_space(reflectances, illuminant, observer)
    if space is None:
        return f"none of {', '.join(COMMON_SPACES)} holds all"
    return f"{space} holds all {len(np.asarray(reflectances))}"


def _look_up(table: Mapping[str, Any], name: str, kind: str) -> Any:
    try:
        return table[name]
    except KeyError:
        raise unknown_name(name, table, kind) from None


@functools.cache
def _samples(table: str, name: str, kind: str, start: float, end: float, step: float) -> Array:
    """Sample a table of colour-science, with constant extrapolation; the result is read-only."""
    colour = colour_science()
    found = _look_up(getattr(colour, table), name, kind).copy().align(colour.SpectralShape(start, end, step))
    samples = np.array(found.values, dtype=float)
    samples.setflags(write=False)
    return samples
