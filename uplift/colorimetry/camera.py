"""Cameras: measured spectral sensitivities, in place of the colour-matching functions
of an observer.
"""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.spectra_json import RGB, is_json, read_spectra
from uplift.common.arrays import Array, StrPath
from uplift.common.csv import find_delimiter, is_decimal, parse_decimal, split_line
from uplift.common.errors import OptionError
from uplift.common.files import read_bytes
from uplift.common.text import format_value

CAMERA = "camera"
"""Name of the RGB space of raw values, balanced so that the perfect reflector is (1, 1,
1).
"""
LAYOUT = "give rows of a wavelength in nm and the sensitivities of red, green and blue"
CAMERA_FILES = (".csv", ".tsv", ".txt", ".json")
"""Suffixes of files of sensitivities, which distinguish them from names."""
MAX_BYTES = 1_000_000
CORRELATED = 50.0
"""Distance in nm over which the correlation of the reflectances that a camera's matrix
is fitted to falls to 1/e.
"""
MAX_CONDITION = 1e4
"""Limit of the condition number of a camera's matrix: one channel is a mixture of the
others beyond it.
"""


@dataclass(frozen=True, eq=False)
class Camera:
    """Spectral sensitivities of a camera with three channels, validated on creation.

    >>> sensitivities = [[0, 0, 2], [0, 4, 0], [3, 0, 0]]
    >>> Camera("narrow", [400, 550, 700], sensitivities).sensitivities.tolist()
    [[0.0, 0.0, 0.5], [0.0, 1.0, 0.0], [0.75, 0.0, 0.0]]
    """

    name: str
    """Name."""
    wavelengths: Array
    """(N,) Wavelengths in nm, ascending."""
    sensitivities: Array
    """(N, 3) Sensitivities of red, green and blue, not negative, in any one unit. They
    are divided by the largest.
    """

    def __post_init__(self) -> None:
        wavelengths = np.array(self.wavelengths, dtype=float)
        sensitivities = np.array(self.sensitivities, dtype=float)
        problem = ""
        if (
            wavelengths.ndim != 1
            or len(wavelengths) < 2
            or sensitivities.shape != (len(wavelengths), 3)
        ):
            shapes = f"{wavelengths.shape} and {sensitivities.shape}"
            problem = (
                "sensitivities need at least 2 wavelengths (N,) and values (N, 3), "
                f"got {shapes}"
            )
        elif not (np.isfinite(wavelengths).all() and np.isfinite(sensitivities).all()):
            problem = "wavelengths and sensitivities must be finite"
        elif (np.diff(wavelengths) <= 0).any():
            first = int((np.diff(wavelengths) <= 0).argmax())
            problem = (
                f"wavelengths must ascend, got {wavelengths[first]:g} nm, then "
                f"{wavelengths[first + 1]:g} nm"
            )
        elif (sensitivities < 0).any():
            problem = f"sensitivities must not be negative, got {sensitivities.min():g}"
        if problem:
            raise OptionError(problem, hint=LAYOUT)
        object.__setattr__(self, "wavelengths", wavelengths)
        object.__setattr__(
            self, "sensitivities", sensitivities / (sensitivities.max() or 1.0)
        )

    def at(self, wavelengths: ArrayLike) -> Array:
        """Interpolate the sensitivities (M, 3) linearly at wavelengths (M,) in nm;
        outside their range they are 0.
        """
        at = np.asarray(wavelengths, dtype=float)
        channels = (
            np.interp(at, self.wavelengths, channel, left=0, right=0)
            for channel in self.sensitivities.T
        )
        return np.stack(list(channels), axis=1)


def camera_sensor(camera: Camera, standard: Sensor) -> Sensor:
    """Make the sensor of a camera's raw values, balanced so that the perfect reflector
    is (1, 1, 1).

    Illuminant, observer and wavelengths are those of a standard sensor. The matrix from
    XYZ, for distances between colours only, is the least-squares fit for smooth
    reflectances, whose values at two wavelengths correlate as exp(−|Δλ| /
    `CORRELATED`).
    """
    nm = standard.wavelengths
    light = standard.light
    sensitivities = camera.at(nm)
    weights = sensitivities * standard.power[:, None]
    if not (weights.sum(axis=0) > 0).all():
        problem = (
            f"every channel must respond to {light.name} within {nm[0]:g}–{nm[-1]:g} nm"
        )
        raise OptionError(problem, hint=LAYOUT)
    # With C the correlation, B the balanced camera and X the weights of XYZ: M = B C Xᵀ
    # (X C Xᵀ)⁻¹.
    balanced = (weights / weights.sum(axis=0)).T
    expected = np.exp(-np.abs(np.subtract.outer(nm, nm)) / CORRELATED) @ light.xyz.T
    matrix = balanced @ expected @ np.linalg.inv(light.xyz @ expected)
    if np.linalg.cond(matrix) > MAX_CONDITION:
        raise OptionError("the channels of a camera must have different sensitivities")
    return replace(
        standard,
        space=camera.name,
        xyz_to_rgb=matrix / (matrix @ light.white)[:, None],
        decoding=np.arange(256) / 255,
        sensitivities=sensitivities,
    )


def read_camera(path: StrPath) -> Camera:
    """Read the sensitivities of a file, whose name without the suffix is that of the
    camera.

    Rows of a table have a wavelength in nm, red, green and blue, separated by commas,
    semicolons, tabs or blanks, with decimal points or commas, in ascending or
    descending order. Rows before them with fewer than two numbers are headers; lines
    that begin with ``#`` are comments. JSON (``.json``) is that of rawtoaces. Raises
    `OptionError` for anything else.
    """
    if is_json(path):
        spectra = read_spectra(path, RGB, OptionError)
        wavelengths = spectra.wavelengths
        sensitivities = spectra.values
    else:
        table = _read_table(path)
        wavelengths = table[:, 0]
        sensitivities = table[:, 1:]
    name = Path(path).stem.encode(errors="backslashreplace").decode()
    try:
        return Camera(name, wavelengths, sensitivities)
    except OptionError as error:
        raise OptionError(
            error.problem, code=error.code, path=path, hint=error.hint
        ) from error


def _read_table(path: StrPath) -> Array:
    """Read rows (N, 4) of a wavelength and three sensitivities, in ascending order if
    they descend.
    """
    data = read_bytes(path, OptionError, limit=MAX_BYTES, hint=LAYOUT)
    encoding = "utf-16" if data.startswith((b"\xff\xfe", b"\xfe\xff")) else "utf-8-sig"
    lines = data.decode(encoding, errors="replace").splitlines()
    table: list[list[float]] = []
    try:
        delimiter = find_delimiter(lines)
        rows = [split_line(line, delimiter) for line in lines]
    except ValueError as error:
        raise OptionError(
            f"is not a readable table: {error}", path=path, hint=LAYOUT
        ) from error
    for line, cells in enumerate(rows, 1):
        is_header = not table and sum(map(is_decimal, cells)) < 2
        if not cells or cells[0].startswith("#") or is_header:
            continue
        try:
            wavelength, red, green, blue = map(parse_decimal, cells)
        except ValueError as error:
            problem = (
                f"a row must have four numbers, got {format_value(lines[line - 1])}"
            )
            raise OptionError(problem, path=path, line=line, hint=LAYOUT) from error
        table.append([wavelength, red, green, blue])
    numbers = np.array(table).reshape(-1, 4)
    descends = len(numbers) > 1 and (np.diff(numbers[:, 0]) < 0).all()
    return numbers[::-1] if descends else numbers
