"""Rates and accuracy of the C header on one core."""

from __future__ import annotations

import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.io.export import write_program
from uplift.lookup import Cube

Floats = NDArray[np.float32]

CHECKED = 5000
"""Colours whose reflectances `rates.c` writes."""
WORST = {"spectra": 1e-3, "moments": 1e-3}
"""Largest permitted difference of reflectance from Python, for random colours in sRGB and nine coefficients."""


@dataclass(frozen=True)
class Rates:
    """Million colours per second: one by one, in one call, from stored multipliers, and with shared cosines."""

    model: str
    coefficients: int
    mode: str
    flags: str
    lookup: float
    many: float
    evaluation: float
    shared: float
    worst: float
    mean_delta_e: float
    max_delta_e: float


@dataclass(frozen=True)
class Accuracy:
    """Differences of reflectance from Python, and the largest multiplier of the cube."""

    space: str
    coefficients: int
    mode: str
    multiplier: float
    mean: float
    above: float
    worst: float


def measure(cube: Cube, mode: str, flags: tuple[str, ...], rgb: Floats, runs: int) -> Rates:
    """Compile the header, check its reflectances, and time it."""
    seconds, found = _run(cube, mode, flags, rgb, runs)
    data, checked = cube.data, rgb[:CHECKED].astype(float)
    worst = float(np.abs(found - cube.reflectance(checked, cube.wavelengths, mode=mode)).max())
    if not worst <= WORST[mode]:
        raise RuntimeError(f"{mode}: reflectances differ by {worst}: nothing to time")
    difference = delta_e_rgb(data.sensor, data.sensor.rgb(found), checked)
    rates = [len(rgb) / each / 1e6 for each in seconds]
    return Rates(
        data.model.name,
        data.model.count,
        mode,
        " ".join(flags),
        *rates,
        worst,
        float(difference.mean()),
        float(difference.max()),
    )


def accuracy(cube: Cube, mode: str, flags: tuple[str, ...]) -> Accuracy:
    """Compare on random colours and, as many, on corners, edges and faces of the cube, where spectra are near a box."""
    rgb = np.random.default_rng(2).random((CHECKED, 3))
    for axes, part in enumerate(np.split(rgb[: CHECKED // 2], [500, 1500]), start=0):
        part[:, : 3 - axes] = np.round(part[:, : 3 - axes])
    rgb = rgb.astype(np.float32)
    _, found = _run(cube, mode, flags, rgb, 0)
    apart = np.abs(found - cube.reflectance(rgb.astype(float), cube.wavelengths, mode=mode))
    model = cube.data.model
    multiplier = np.abs(model.from_storage(cube.data.points.coefficients)).max()
    return Accuracy(
        cube.data.sensor.space,
        model.count,
        mode,
        float(multiplier),
        float(apart.mean()),
        float((apart > 1e-4).mean()),
        float(apart.max()),
    )


def _run(cube: Cube, mode: str, flags: tuple[str, ...], rgb: Floats, runs: int) -> tuple[list[float], NDArray[Any]]:
    """Return the fewest CPU seconds by task, and reflectances of the first colours."""
    source = Path(__file__).with_name("rates.c")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_program(cube.data, folder / "cube.h", mode=mode)
        rgb.tofile(folder / "rgb")
        cube.wavelengths.astype(np.float32).tofile(folder / "at")
        subprocess.run(["cc", *flags, "-I.", str(source), "-o", "rates", "-lm"], cwd=folder, check=True)
        command = ["./rates", "rgb", "at", str(runs), "found"]
        done = subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True)
        found = np.fromfile(folder / "found", np.float32).reshape(CHECKED, -1).astype(float)
    return [float(word) for word in done.stdout.split()[:-1]], found
