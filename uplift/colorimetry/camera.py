"""Cameras: measured spectral sensitivities, in place of the colour-matching functions of an observer."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array, StrPath
from uplift.common.errors import OptionError
from uplift.common.files import read_bytes
from uplift.common.text import format_value, parse_float

CAMERA = "camera"
"""Name of the RGB space of raw values, balanced so that the perfect reflector is (1, 1, 1)."""
LAYOUT = "give rows of a wavelength in nm and the sensitivities of red, green and blue"
MAX_BYTES = 1_000_000
COLUMNS = 4
CORRELATED = 50.0
"""Distance in nm at which the correlation of reflectances that a camera's matrix is fitted to falls to 1/e."""
MAX_CONDITION = 1e4
"""Limit of the condition number of a camera's matrix: one channel is a mixture of the others beyond it."""


@dataclass(frozen=True, eq=False)
class Camera:
    """Spectral sensitivities of a camera with three channels, validated on creation.

    >>> Camera("narrow", [400, 550, 700], [[0, 0, 2], [0, 4, 0], [3, 0, 0]]).sensitivities.tolist()
    [[0.0, 0.0, 0.5], [0.0, 1.0, 0.0], [0.75, 0.0, 0.0]]
    """

    name: str
    """Name."""
    wavelengths: Array
    """(N,) Wavelengths in nm, ascending."""
    sensitivities: Array
    """(N, 3) Sensitivities of red, green and blue, not negative, in any one unit. They are divided by the largest."""

    def __post_init__(self) -> None:
        wavelengths = np.array(self.wavelengths, dtype=float)
        sensitivities = np.array(self.sensitivities, dtype=float)
        if wavelengths.ndim != 1 or len(wavelengths) < 2 or sensitivities.shape != (len(wavelengths), 3):
            raise OptionError(
                f"sensitivities need at least 2 wavelengths (N,) and values (N, 3), got {wavelengths.shape} and "
                f"{sensitivities.shape}",
                hint=LAYOUT,
            )
        if not (np.isfinite(wavelengths).all() and np.isfinite(sensitivities).all()):
            raise OptionError("wavelengths and sensitivities must be finite", hint=LAYOUT)
        bad = np.flatnonzero(np.diff(wavelengths) <= 0)
        if len(bad):
            first, second = wavelengths[bad[0] : bad[0] + 2]
            raise OptionError(
                f"wavelengths must ascend, got {first:g} nm, then {second:g} nm",
                hint="sort the rows by wavelength, each wavelength once",
            )
        if (sensitivities < 0).any():
            row, channel = np.argwhere(sensitivities < 0)[0]
            raise OptionError(
                f"sensitivities must not be negative, got {sensitivities[row, channel]:g} at {wavelengths[row]:g} nm",
                hint="set noise below zero to 0",
            )
        object.__setattr__(self, "wavelengths", wavelengths)
        object.__setattr__(self, "sensitivities", sensitivities / (sensitivities.max() or 1.0))

    def at(self, wavelengths: ArrayLike) -> Array:
        """Interpolate the sensitivities linearly; outside the measured range they are 0.

        Shapes: ``wavelengths`` (M,) → (M, 3).
        """
        at = np.asarray(wavelengths, dtype=float)
        channels = (np.interp(at, self.wavelengths, channel, left=0, right=0) for channel in self.sensitivities.T)
        return np.stack(list(channels), axis=1)


def camera_sensor(camera: Camera, wavelengths: Array, light: Light, power: Array, observer: str, cmfs: Array) -> Sensor:
    """Make the sensor of a camera's raw values, balanced so that the perfect reflector is (1, 1, 1).

    Its matrix from XYZ, for distances between colours only, is the least-squares fit for smooth reflectances, whose
    values at two wavelengths correlate as exp(−|Δλ| / `CORRELATED`).
    """
    sensitivities = camera.at(wavelengths)
    weights = sensitivities * power[:, None]
    if not (weights.sum(axis=0) > 0).all():
        raise OptionError(
            f"every channel must respond to {light.name} within {wavelengths[0]:g}–{wavelengths[-1]:g} nm",
            hint="give wavelengths in nm, and sensitivities of red, green and blue",
        )
    balanced = (weights / weights.sum(axis=0)).T
    correlation = np.exp(-np.abs(np.subtract.outer(wavelengths, wavelengths)) / CORRELATED)
    expected = correlation @ light.xyz.T
    matrix = balanced @ expected @ np.linalg.inv(light.xyz @ expected)
    if np.linalg.cond(matrix) > MAX_CONDITION:
        raise OptionError("the channels of a camera must have different sensitivities")
    return Sensor(
        space=camera.name,
        illuminant=light.name,
        observer=observer,
        wavelengths=wavelengths,
        cmfs=cmfs,
        power=power,
        xyz_to_rgb=matrix / (matrix @ light.white)[:, None],
        decoding=np.arange(256) / 255,
        sensitivities=sensitivities,
    )


def read_camera(path: StrPath) -> Camera:
    """Read sensitivities from a CSV file: rows of a wavelength in nm, red, green and blue.

    A first row without numbers is a header; lines that begin with ``#`` are comments.
    """
    text = read_bytes(path, OptionError, limit=MAX_BYTES, hint=LAYOUT).decode("utf-8-sig", errors="replace")
    try:
        table = np.array(list(_rows(text, path))).reshape(-1, COLUMNS)
    except csv.Error as error:
        problem = f"not a readable table: {error}"
        raise OptionError(problem, path=path, hint=LAYOUT) from error
    name = Path(path).stem.encode(errors="backslashreplace").decode()
    try:
        return Camera(name, table[:, 0], table[:, 1:])
    except OptionError as error:
        raise OptionError(error.problem, code=error.code, path=path, hint=error.hint) from error


def _rows(text: str, path: StrPath) -> Iterator[list[float]]:
    """Yield the numbers of each row but the header, comments and blank lines."""
    reader, begun = csv.reader(text.splitlines()), False
    for cells in reader:
        filled = [cell for cell in cells if cell.strip()]
        if not filled or filled[0].lstrip().startswith("#"):
            continue
        numbers = [_number(cell) for cell in filled]
        known = [number for number in numbers if number is not None]
        if len(known) == len(filled) == COLUMNS:
            yield known
        elif begun or known:
            problem = f"a row must have {COLUMNS} numbers, got {format_value(','.join(cells))}"
            raise OptionError(problem, path=path, line=reader.line_num, hint=LAYOUT)
        begun = True


def _number(cell: str) -> float | None:
    try:
        return parse_float(cell)
    except ValueError:
        return None
