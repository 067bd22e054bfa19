"""The sensor that several cubes share."""

from __future__ import annotations

from collections.abc import Iterable

from uplift.colorimetry.sensor import Sensor
from uplift.common.errors import OptionError
from uplift.lookup.cube import Cube


def common_sensor(cubes: Iterable[Cube]) -> Sensor:
    """Return the sensor of cubes that have the same RGB space, illuminant and observer.

    Parameters
    ----------
    cubes : iterable of Cube
        At least one cube.

    Returns
    -------
    Sensor
        That of the first cube.

    Raises
    ------
    OptionError
        The cubes differ (code ``cubes-of-different-spaces``).
    """
    cubes = list(cubes)
    spaces = {(cube.space, cube.illuminant, cube.observer) for cube in cubes}
    if len(spaces) > 1:
        names = " and ".join(", ".join(space) for space in sorted(spaces))
        raise OptionError(
            f"cubes that are used together must have one RGB space, illuminant and observer, got {names}",
            code="cubes-of-different-spaces",
            hint="build the cube with the settings of the other",
        )
    return cubes[0].data.sensor
