"""Observers, illuminants and RGB spaces by name: the one module that reads colour-science's tables."""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from uplift.colorimetry.camera import CAMERA, Camera, read_camera
from uplift.colorimetry.gamut import Primaries, conversion
from uplift.colorimetry.lights import DEFAULT_ILLUMINANT, Lamps
from uplift.colorimetry.ocio import AP0, OcioSpace, find_ocio_space
from uplift.colorimetry.sensor import Light, Sensor
from uplift.colorimetry.srgb import decode_portably
from uplift.common.arrays import Array
from uplift.common.colour_science import colour_science
from uplift.common.errors import OptionError, unknown_name

DEFAULT_OBSERVER = "CIE 1931 2 Degree Standard Observer"
CRT = "Typical CRT Brainard 1997"
"""Phosphors of a cathode-ray tube, measured by D. H. Brainard."""
SHORT_NAMES = {
    "ap0": "ACES2065-1",
    "ap1": "ACEScg",
    "rec709": "ITU-R BT.709",
    "bt709": "ITU-R BT.709",
    "rec2020": "ITU-R BT.2020",
    "bt2020": "ITU-R BT.2020",
    "p3": "Display P3",
    "prophoto": "ProPhoto RGB",
}
"""Names of colour-science by usual short ones, in lower case and without punctuation."""
FIRST_SPACES = ("sRGB", "Display P3", "ITU-R BT.2020", "ACEScg", "Adobe RGB (1998)")
"""Spaces of colour-science that stand for others with the same primaries."""
MAX_MATRIX_DIFFERENCE = 1e-3
"""Largest difference between matrices of the same primaries, of which some are rounded."""
CORRELATED = 50.0
"""Distance in nm at which the correlation of reflectances that a camera's matrix is fitted to falls to 1/e."""
MAX_CONDITION = 1e4
"""Limit of the condition number of a camera's matrix: one channel is a mixture of the others beyond it."""
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
        return _camera_sensor(find_camera(observer), illuminant)
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
    """Return a sensor with another range of wavelengths, where the perfect reflector is white again.

    Parameters
    ----------
    sensor : Sensor
        The sensor.
    start, end, step : float
        Range and step in nm. Outside their tables, illuminant and observer are extrapolated as constants; the
        sensitivities of a camera are 0.

    Returns
    -------
    Sensor
        The sensor itself for its own range.
    """
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
    """Find the sensitivities of a camera.

    Parameters
    ----------
    camera : str or Camera
        Name of colour-science, such as ``"Nikon 5100 (NPL)"``, or the path of a CSV file; see
        `uplift.colorimetry.camera.read_camera`.

    Returns
    -------
    Camera

    Raises
    ------
    UnknownNameError
        The name is unknown (``unknown-camera``).
    OptionError
        The file cannot be used.
    """
    if isinstance(camera, Camera):
        return camera
    if camera.casefold().endswith(".csv"):
        return read_camera(camera)
    found = _look_up(colour_science().MSDS_CAMERA_SENSITIVITIES, camera, "camera")
    return Camera(found.name, found.wavelengths, found.values)


def _camera_sensor(camera: Camera, illuminant: str) -> Sensor:
    if camera.name in colour_science().RGB_COLOURSPACES:
        raise OptionError(f"a camera must not have the name of an RGB space, got '{camera.name}'")
    build_light, power, sensitivities = light(illuminant), illuminant_spd(illuminant), camera.at(grid())
    weights = sensitivities * power[:, None]
    if not (weights.sum(axis=0) > 0).all():
        raise OptionError(
            f"every channel must respond to {build_light.name} within {START:g}–{END:g} nm",
            hint="give wavelengths in nm, and sensitivities of red, green and blue",
        )
    balanced = (weights / weights.sum(axis=0)).T
    correlation = np.exp(-np.abs(np.subtract.outer(grid(), grid())) / CORRELATED)
    expected = correlation @ build_light.xyz.T
    matrix = balanced @ expected @ np.linalg.inv(build_light.xyz @ expected)
    if np.linalg.cond(matrix) > MAX_CONDITION:
        raise OptionError("the channels of a camera must have different sensitivities")
    return Sensor(
        space=camera.name,
        illuminant=build_light.name,
        observer=DEFAULT_OBSERVER,
        wavelengths=grid(),
        cmfs=matching_functions(),
        power=power,
        xyz_to_rgb=matrix / (matrix @ build_light.white)[:, None],
        decoding=np.arange(256) / 255,
        sensitivities=sensitivities,
    )


def display_sensors(
    illuminants: Sequence[str], observer: str, start: float = START, end: float = END, step: float = STEP
) -> tuple[Sensor, ...]:
    """Create an sRGB sensor for each illuminant, without duplicates.

    Their linear RGB can be displayed directly: the white of each illuminant becomes the white of the screen.

    Parameters
    ----------
    illuminants : sequence of str
        Illuminants; aliases of one illuminant give one sensor.
    observer : str
        Colour-matching functions.
    start, end, step : float
        Range and step in nm, as `Sensor.range`.

    Returns
    -------
    tuple of Sensor

    Raises
    ------
    UnknownNameError
        A name is unknown.
    """
    sensors = (on_range(sensor("sRGB", name, observer), start, end, step) for name in illuminants)
    return tuple({each.illuminant: each for each in sensors}.values())


def primaries(space: str) -> Primaries:
    """Return the primaries and white of an RGB space.

    Parameters
    ----------
    space : str
        RGB space.

    Returns
    -------
    Primaries

    Raises
    ------
    UnknownNameError
        The space is unknown.
    """
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
    """Return the observer and illuminant of a sensor as objects of colour-science.

    Parameters
    ----------
    sensor : Sensor
        The sensor.
    start, end, step : float
        Range and step in nm; outside the table, values are extrapolated as constants.

    Returns
    -------
    tuple
        Colour-matching functions and spectral distribution of the illuminant.
    """
    colour = colour_science()
    shape = colour.SpectralShape(start, end, step)
    cmfs, light = colour.MSDS_CMFS[sensor.observer], colour.SDS_ILLUMINANTS[sensor.illuminant]
    return cmfs.copy().align(shape), light.copy().align(shape)


def axis_nodes(spacing: str, dim: int) -> Array:
    """Return the positions of the nodes of a lattice axis in linear RGB.

    They are the same doubles on every CPU, so cubes of one dim and spacing have equal nodes wherever they were built.

    Parameters
    ----------
    spacing : {"srgb", "linear"}
        Transfer curve in which the nodes are evenly spaced.
    dim : int
        Number of nodes.

    Returns
    -------
    ndarray, shape (dim,)
        Positions from 0 to 1, ascending.

    Raises
    ------
    UnknownNameError
        The spacing is unknown.
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
    """Return colour-matching functions.

    Parameters
    ----------
    observer : str
        Their name.
    start, end, step : float
        Range and step in nm; outside the table, values are extrapolated as constants.

    Returns
    -------
    ndarray, shape (N, 3)

    Raises
    ------
    UnknownNameError
        The observer is unknown.
    """
    return _samples("MSDS_CMFS", observer, "observer", start, end, step)


def illuminant_spd(illuminant: str, start: float = START, end: float = END, step: float = STEP) -> Array:
    """Return the relative spectral power of an illuminant.

    Parameters
    ----------
    illuminant : str
        Its name.
    start, end, step : float
        Range and step in nm; outside the table, values are extrapolated as constants.

    Returns
    -------
    ndarray, shape (N,)

    Raises
    ------
    UnknownNameError
        The illuminant is unknown.
    """
    return _samples("SDS_ILLUMINANTS", illuminant, "illuminant", start, end, step)


def lamps(observer: str = DEFAULT_OBSERVER, start: float = START, end: float = END, step: float = STEP) -> Lamps:
    """Return the lights of colour-science: CIE illuminants and measured lamps.

    Lights that are measured on less than 400–700 nm, and lights with the spectrum of an earlier one, are left out.

    Parameters
    ----------
    observer : str
        Colour-matching functions.
    start, end, step : float
        Range and step in nm; outside the table, values are extrapolated as constants.

    Returns
    -------
    Lamps
        Powers of luminance 1.

    Raises
    ------
    UnknownNameError
        The observer is unknown.
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
    """Return the relative spectral power of the primaries of a display.

    Parameters
    ----------
    display : str
        Its name.
    start, end, step : float
        Range and step in nm; outside the table, values are extrapolated as constants.

    Returns
    -------
    ndarray, shape (N, 3)

    Raises
    ------
    UnknownNameError
        The display is unknown.
    """
    return _samples("MSDS_DISPLAY_PRIMARIES", display, "display", start, end, step)


def illuminant_names() -> tuple[str, ...]:
    """Return the names of all illuminants.

    Returns
    -------
    tuple of str
        Names of colour-science, aliases included, in the order of its tables.

    Examples
    --------
    >>> "FL11" in illuminant_names()
    True
    """
    return tuple(colour_science().SDS_ILLUMINANTS)


def observer_names() -> tuple[str, ...]:
    """Return the names of all standard observers.

    Returns
    -------
    tuple of str
        Names of colour-science, aliases included, in the order of its tables.

    Examples
    --------
    >>> DEFAULT_OBSERVER in observer_names()
    True
    """
    return tuple(colour_science().MSDS_CMFS)


def camera_names() -> tuple[str, ...]:
    """Return the names of all cameras.

    Returns
    -------
    tuple of str
        Names of colour-science.

    Examples
    --------
    >>> camera_names()
    ('Nikon 5100 (NPL)', 'Sigma SDMerill (NPL)')
    """
    return tuple(colour_science().MSDS_CAMERA_SENSITIVITIES)


def space_names() -> tuple[str, ...]:
    """Return the names of all RGB spaces.

    Returns
    -------
    tuple of str
        Names of colour-science, aliases included, in the order of its tables.

    Examples
    --------
    >>> "sRGB" in space_names()
    True
    """
    return tuple(colour_science().RGB_COLOURSPACES)


def look_up_space(name: str, *, ocio: bool = True) -> Any:
    """Find an RGB space of colour-science.

    Parameters
    ----------
    name : str
        Its name, a short name, or the name of a space of OpenColorIO with the same primaries and white.
    ocio : bool
        Whether to accept names of OpenColorIO.

    Returns
    -------
    RGB_Colourspace
        The object of colour-science.

    Raises
    ------
    UnknownNameError
        The name is unknown.
    """
    table = colour_science().RGB_COLOURSPACES
    for each in (name, SHORT_NAMES.get(re.sub(r"[ ._-]", "", name.casefold()), name)):
        if each in table:
            return table[each]
    found = find_ocio_space(name) if ocio else None
    if found is not None:
        for each in (*FIRST_SPACES, *table):
            if _same_primaries(table[each], found):
                return table[each]
    raise unknown_name(name, table, "RGB space")


def _same_primaries(space: Any, found: OcioSpace) -> bool:
    expected = conversion(Primaries.of([*space.primaries.ravel(), *space.whitepoint]), AP0)
    return bool(np.abs(found.to_ap0(np.eye(3)).T - expected).max() <= MAX_MATRIX_DIFFERENCE)


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
