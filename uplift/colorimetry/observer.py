"""Sensors, lights and observers by name, from the tables of colour-science.

Tables are sampled from ``start`` to ``end`` every ``step`` nm. Outside their tables
lights keep their last value, and observers are 0. Names that are unknown raise
`UnknownNameError`, whose hint gives the nearest ones.
"""

import functools
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry import tables
from uplift.colorimetry.camera import (
    CAMERA,
    CAMERA_FILES,
    Camera,
    camera_sensor,
)
from uplift.colorimetry.illuminants import DEFAULT_ILLUMINANT, Illuminant, Lamp
from uplift.colorimetry.sensor import Light, Sensor, in_unit_cube
from uplift.colorimetry.tables import WAVELENGTHS, samples
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.extensions import extension

DEFAULT_OBSERVER = "CIE 1931 2 Degree Standard Observer"
COMMON_SPACES = ("sRGB", "Display P3", "ITU-R BT.2020", "ACEScg", "ProPhoto RGB")
"""Names of colour-science, by the area of the gamut in CIE 1976 u′, v′."""
START, END, STEP = WAVELENGTHS
"""Range and step in nm of a sensor by default."""


def grid() -> Array:
    """Return the wavelengths (81,) of a sensor by default: 380–780 nm at 5 nm."""
    return np.arange(START, END + STEP / 2, STEP)


def sensor(
    space: str = "sRGB",
    illuminant: Illuminant = DEFAULT_ILLUMINANT,
    observer: str | Camera = DEFAULT_OBSERVER,
    wavelengths: tuple[float, float, float] = WAVELENGTHS,
) -> Sensor:
    """Create a sensor from names of colour-science.

    Bradford adaptation takes the white of the illuminant to the white of the space.
    Each row of the matrix is scaled so that the perfect reflector gives (1, 1, 1) up to
    rounding.

    Parameters
    ----------
    space : str
        RGB space: a name of colour-science, a short name such as ``AP1``, or a name of
        OpenColorIO, such as ``lin_rec2020``, of a space that colour-science has as
        well. ``"camera"`` are raw values of a camera.
    illuminant : str or Lamp
        Illuminant that the RGB refer to.
    observer : str or Camera
        Colour-matching functions; for the space ``"camera"`` a camera, see
        `find_camera`. XYZ of a camera's sensor are those of the CIE 1931 observer.
    wavelengths : tuple of float, default (380, 780, 5)
        First and last wavelength and step in nm, as `Sensor.range`.

    Returns
    -------
    Sensor

    Raises
    ------
    UnknownNameError
        A name is unknown; the hint gives the nearest names.
    OptionError
        A camera without its space, or one that cannot be used (see `Camera`), or a
        colour temperature out of range.

    Examples
    --------
    >>> import numpy as np
    >>> sensor("sRGB").rgb(np.full(81, 0.5)).round(12).tolist()
    [0.5, 0.5, 0.5]
    """
    if wavelengths != WAVELENGTHS:
        return on_range(
            sensor(space, illuminant, observer), *wavelengths, illuminant=illuminant
        )
    if space == CAMERA:
        camera = find_camera(observer)
        if tables.rgb_space(camera.name) is not None:
            raise OptionError(
                f"a camera must not have the name of an RGB space, got '{camera.name}'"
            )
        return camera_sensor(camera, sensor(illuminant=illuminant))
    if isinstance(observer, Camera) or is_camera(observer):
        raise OptionError(
            "a camera in place of an observer has its own RGB space",
            hint=f"use space='{CAMERA}'",
        )
    rgb_space = tables.rgb_space(space)
    if rgb_space is None:
        rgb_space = extension("spaces", "of OpenColorIO")(space)
    build_light = light(illuminant, observer)
    # XYZ to RGB is M_space · M_Bradford: the white of the illuminant becomes the white
    # of the space.
    x, y = rgb_space.whitepoint
    adapt = tables.bradford(build_light.white, np.array([x / y, 1.0, (1 - x - y) / y]))
    matrix = rgb_space.matrix_XYZ_to_RGB @ adapt
    return Sensor(
        space=rgb_space.name,
        illuminant=build_light.name,
        observer=tables.stated_name("observer", observer),
        wavelengths=grid(),
        cmfs=samples("observer", observer),
        power=samples("illuminant", illuminant),
        xyz_to_rgb=matrix / (matrix @ build_light.white)[:, None],
        decoding=rgb_space.decoding,
    )


def on_range(
    sensor: Sensor,
    start: float,
    end: float,
    step: float,
    *,
    illuminant: Illuminant | None = None,
) -> Sensor:
    """Return a sensor with a range of wavelengths, where the perfect reflector is white
    again.

    ``illuminant`` is that of the sensor, which must be given if it is a lamp.
    """
    if sensor.range == (start, end, step):
        return sensor
    illuminant = sensor.illuminant if illuminant is None else illuminant
    wide = light(illuminant, sensor.observer, start, end, step)
    wavelengths = np.arange(start, end + step / 2, step)
    sensitivities = None
    if sensor.sensitivities is not None:
        sensitivities = Camera(
            sensor.space, sensor.wavelengths, sensor.sensitivities
        ).at(wavelengths)
    return replace(
        sensor,
        wavelengths=wavelengths,
        cmfs=samples("observer", sensor.observer, start, end, step),
        power=samples("illuminant", illuminant, start, end, step),
        xyz_to_rgb=sensor.xyz_to_rgb / (sensor.xyz_to_rgb @ wide.white)[:, None],
        sensitivities=sensitivities,
    )


def is_camera_file(observer: str) -> bool:
    """Whether the name of an observer is that of a file of sensitivities, which is
    read.
    """
    return observer.casefold().endswith(CAMERA_FILES)


def is_camera(observer: str | Camera) -> bool:
    """Whether an observer is a camera, or the name or file of one."""
    return (
        isinstance(observer, Camera)
        or is_camera_file(observer)
        or observer in tables.names("camera")
    )


def require_observer(observer: str | Camera, purpose: str) -> None:
    """Raise `OptionError` for a camera in place of an observer, where XYZ are needed
    for a ``purpose``.
    """
    if is_camera(observer):
        name = observer.name if isinstance(observer, Camera) else observer
        problem = (
            f"{purpose} need XYZ, which raw values of the camera '{name}' do not "
            "determine"
        )
        raise OptionError(problem, hint="use a standard observer")


def find_camera(camera: str | Camera) -> Camera:
    """Find the sensitivities of a camera."""
    if isinstance(camera, Camera):
        return camera
    if is_camera_file(camera):
        camera_of_file: Camera = extension("cameras", "files")(camera)
        return camera_of_file
    found = tables.look_up("camera", camera)
    return Camera(found.name, found.wavelengths, found.values)


def display_sensors(
    illuminants: Sequence[Illuminant],
    observer: str,
    start: float = START,
    end: float = END,
    step: float = STEP,
    *,
    space: str = "sRGB",
) -> tuple[Sensor, ...]:
    """Create a sensor, by default of sRGB, for each illuminant, without duplicates.

    Their linear RGB can be displayed directly: the white of each illuminant becomes the
    white of the screen. Raises `OptionError` for two lamps of one name.
    """
    check_distinct(illuminants)
    sensors = (
        sensor(space, name, observer, (start, end, step)) for name in illuminants
    )
    return tuple({display.illuminant: display for display in sensors}.values())


def check_distinct(illuminants: Iterable[Illuminant]) -> None:
    """Check that no two different lamps, nor a lamp and an illuminant, have the same
    name in results.
    """
    known: dict[str, Lamp | None] = {}
    for illuminant in illuminants:
        name = tables.stated_name("illuminant", illuminant)
        lamp = illuminant if isinstance(illuminant, Lamp) else None
        if known.setdefault(name, lamp) != lamp:
            raise OptionError(
                f"two lights have the name '{name}'", hint="rename one of them"
            )


@functools.cache
def light(
    illuminant: Illuminant,
    observer: str = DEFAULT_OBSERVER,
    start: float = START,
    end: float = END,
    step: float = STEP,
) -> Light:
    """Create a light, by default on the wavelengths of `grid`.

    Parameters
    ----------
    illuminant : str or Lamp
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
    OptionError
        A colour temperature is out of range.
    """
    power = samples("illuminant", illuminant, start, end, step)
    weights = samples("observer", observer, start, end, step) * power[:, None]
    return Light(
        tables.stated_name("illuminant", illuminant),
        (weights / weights[:, 1].sum()).T,
        illuminant if isinstance(illuminant, Lamp) else None,
    )


def lights(
    illuminants: Iterable[Illuminant],
    observer: str = DEFAULT_OBSERVER,
    wavelengths: tuple[float, float, float] = WAVELENGTHS,
) -> list[Light]:
    """Create a light for each illuminant, without duplicates.

    Raises `OptionError` for two lamps of one name.
    """
    check_distinct(illuminants := tuple(illuminants))
    made = [light(illuminant, observer, *wavelengths) for illuminant in illuminants]
    return list({light.name: light for light in made}.values())


def matching_functions(
    observer: str = DEFAULT_OBSERVER,
    start: float = START,
    end: float = END,
    step: float = STEP,
) -> Array:
    """Return colour-matching functions. Shape (N, 3)."""
    return samples("observer", observer, start, end, step)


def illuminant_spd(
    illuminant: Illuminant, start: float = START, end: float = END, step: float = STEP
) -> Array:
    """Return the relative spectral power of an illuminant. Shape (N,)."""
    return samples("illuminant", illuminant, start, end, step)


def smallest_space(
    reflectances: ArrayLike,
    illuminant: Illuminant = DEFAULT_ILLUMINANT,
    observer: str = DEFAULT_OBSERVER,
) -> str | None:
    """Find the smallest of `COMMON_SPACES` that holds all colours of reflectances (…,
    81) on `grid`; None if none does.

    >>> import numpy as np
    >>> smallest_space(np.full(81, 0.5))
    'sRGB'
    """
    candidates = (sensor(space, illuminant, observer) for space in COMMON_SPACES)
    holding = (
        candidate.space
        for candidate in candidates
        if in_unit_cube(candidate.rgb(reflectances)).all()
    )
    return next(holding, None)
