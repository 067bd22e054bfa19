"""Methods of spectral upsampling, and the sensors by which their round trips are
measured.

Round trips are measured at 1 nm, with the observer, the illuminant, the white and the
matrix that a method states. No method was fitted at 1 nm. Cubes are fitted to 380–780
nm at 5 nm: errors there would favour our range, step and matrix.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.colorimetry.illuminants import DEFAULT_ILLUMINANT
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array, Values
from uplift.common.colour_science import colour_science
from uplift.lab.description import Description
from uplift.lab.runner import Errors, Task, spectrum_errors

RANGE = (360.0, 830.0, 1.0)
"""First and last wavelength and step in nm: those of the CIE 1931 observer."""
Uplift = Callable[[Values, Array], Values]
"""From linear sRGB (n, 3) in [0, 1] and wavelengths (N,) in nm to reflectances (n, N),
in the method's data type.
"""


def at_1_nm(sensor: Sensor) -> Sensor:
    """Return a sensor on `RANGE`, the statement of a cube: its white stays white."""
    return observer.on_range(sensor, *RANGE)


def stated_sensor(xyz_to_rgb: Array, illuminant: str = DEFAULT_ILLUMINANT) -> Sensor:
    """Return the sensor on `RANGE` of a stated matrix (3, 3)."""
    sensor = observer.sensor(illuminant=illuminant)
    return replace(at_1_nm(sensor), xyz_to_rgb=xyz_to_rgb)


@cache
def ours() -> Sensor:
    """Return the statement of cubes for linear sRGB under D65."""
    return at_1_nm(observer.sensor())


@cache
def published_srgb() -> Sensor:
    """Return the statement of methods for sRGB: the matrix of IEC 61966-2-1, D65."""
    return stated_sensor(colour_science().RGB_COLOURSPACES["sRGB"].matrix_XYZ_to_RGB)


class NotInstalledError(Exception):
    """A package that a method needs is missing; the text names it."""


@dataclass(frozen=True, eq=False)
class PreparedMethod:
    """A method that has spectra, ready for use.

    ``build_s``: CPU seconds to compute its tables, once; 0 if there are none to
    compute, None if they come from elsewhere. ``load_s``: CPU seconds to read and
    prepare them in a process. The first call, which may compile, is charged separately.
    ``stated``: returns the standard errors and error bounds (n, 2) that the method
    states for RGB under a light.
    """

    uplift: Uplift
    bytes: int = 0
    build_s: float | None = 0.0
    load_s: float = 0.0
    stated: Callable[[Array, Light], Array] | None = None

    def errors(self, task: Task, lights: Sequence[Light]) -> Errors:
        """Compare the spectra of a task's colours with its measurements."""
        predicted = self.uplift(task.rgb, task.sensor.wavelengths)
        errors = spectrum_errors(predicted, task.queried, lights)
        if self.stated is None:
            return errors
        stated = [self.stated(task.rgb, light) for light in lights]
        return replace(errors, stated=np.stack(stated, axis=1))


@dataclass(frozen=True, eq=False)
class PreparedMap:
    """A map of colours, which has no spectra.

    ``colours``: returns the XYZ (n, 3), relative to white, that RGB have under a light.
    """

    colours: Callable[[Array, Light], Array]

    def errors(self, task: Task, lights: Sequence[Light]) -> Errors:
        """Compare the colours under lights with those of the measurements."""
        columns = []
        for light in lights:
            mapped = lab(self.colours(task.rgb, light), np.ones(3))
            actual = lab(task.queried @ light.xyz.T, light.white)
            columns.append(delta_e_2000(mapped, actual))
        return Errors(np.stack(columns, axis=1))


@dataclass(frozen=True, kw_only=True)
class Method(Description):
    """A method of spectral upsampling. A method far off the claims of its authors is
    broken and is not drawn.

    ``prepare``: from a `Task` to a `PreparedMethod`. Raises `NotInstalledError`.
    ``reference_sensor``: returns the sensor of the white and the matrix that the method
    states, see `published_srgb`. ``claimed_error``: mean ΔE00 of round trips that its
    authors claim. ``claimed_range``: range of reflectances that its authors claim.
    ``needs``: native code beyond this package and how to install it; empty if there is
    none. A method that needs some is measured in a child process, as it may crash or
    hang.
    """

    prepare: Callable[[Task], PreparedMethod]
    reference_sensor: Callable[[], Sensor] = published_srgb
    claimed_error: float | None = None
    claimed_range: tuple[float, float] = (0.0, 1.0)
    needs: str = ""


def in_float32(double: Method) -> Method:
    """Describe a method in float32."""
    return replace(
        double,
        method=f"{double.method}-float32",
        title=f"{double.title}, float32",
        label=f"{double.label or double.title} f32",
        dtype="float32",
    )


def nbytes(*arrays: Values | Any) -> int:
    """Size of arrays."""
    return sum(array.nbytes for array in arrays)


def interpolated(
    spectra: Callable[[Array], Array], task: Task, size: int, build_s: float = 0.0
) -> PreparedMethod:
    """Return a method whose spectra are at the wavelengths of the task; others are
    interpolated linearly.
    """
    at = task.sensor.wavelengths

    def uplift(rgb: Array, wavelengths: Array) -> Array:
        rows = [np.interp(wavelengths, at, row) for row in spectra(rgb)]
        return np.stack(rows)

    return PreparedMethod(uplift, size, build_s)
