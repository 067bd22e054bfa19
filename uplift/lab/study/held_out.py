"""Half of an atlas as constraint, the other half asked: what a cube makes of materials that it has not seen."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.atlas import Atlas, resample
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.lights import HELD_OUT_LIGHTS
from uplift.common.arrays import Array, Indices
from uplift.common.errors import AtlasError, UpliftWarning
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.lookup import Cube
from uplift.pipeline import build
from uplift.report.calibration import Calibration, calibration

FEWEST = 8
"""Entries within the space that can be halved."""


@dataclass(frozen=True, eq=False)
class SpectrumErrors:
    """Answers against measurements of n colours: rms (n,) over wavelength, ΔE00 (n, L) under L lights."""

    rms: Array
    delta_e: Array

    def means(self) -> Array:
        """(1 + L,) mean rms, then mean ΔE00 under each light."""
        return np.concatenate([[self.rms.mean()], self.delta_e.mean(axis=0)])


@dataclass(frozen=True, eq=False)
class HoldoutSplit:
    """One way to halve an atlas. ``errors`` by what answered; ``stated`` (n,) standard errors, if the cube has any.

    ``real`` (n,) is what the stated errors are about: ΔE00 under the cube's reference light.
    """

    errors: dict[str, SpectrumErrors]
    real: Array
    stated: Array | None


def spectrum_errors(
    answered: Array, measured: Array, lights: Sequence[str] = HELD_OUT_LIGHTS
) -> SpectrumErrors:
    """Errors of reflectances (n, N), on the grid of every sensor, against measurements (n, N)."""
    rms = np.sqrt(((answered - measured) ** 2).mean(axis=1))
    return SpectrumErrors(
        rms, np.stack([delta_e_spectra(observer.light(name), answered, measured) for name in lights], axis=1)
    )


def holdout(
    spectra: Atlas,
    splits: int = 3,
    progress: ProgressCallback = ignore_progress,
    **options: Any,
) -> tuple[HoldoutSplit, ...]:
    """Halve an atlas ``splits`` times, build a cube from one half with ``options``, ask it for the other.

    Beside the cube answer one of the same options without an atlas, and the sigmoid's. ``progress`` hears how many
    cubes are built, and of how many.

    Raises
    ------
    AtlasError : too few entries within the space.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        others = {
            "without an atlas": build(**options),
            "sigmoid": build(**{**options, "model": "sigmoid"}),
        }
        progress(Progress("builds", 2, 2 + splits))
        inside = _inside(spectra, others["sigmoid"])
        found = []
        for number in range(splits):
            order = np.random.default_rng(number).permutation(len(inside))
            kept, asked = np.array_split(order, 2)
            cube = build(_some(spectra, inside[kept]), **options)
            found.append(_ask({"half the atlas": cube, **others}, _some(spectra, inside[asked])))
            progress(Progress("builds", 3 + number, 2 + splits))
    return tuple(found)


def _ask(cubes: dict[str, Cube], asked: Atlas) -> HoldoutSplit:
    cube = cubes["half the atlas"]
    sensor = cube.data.sensor
    measured = resample(asked, sensor.wavelengths).values
    rgb = np.clip(sensor.rgb(measured), 0, 1)
    answers = {name: other.reflectance(rgb) for name, other in cubes.items()}
    light = observer.light(cube.data.error_illuminant, sensor.observer)
    return HoldoutSplit(
        {name: spectrum_errors(answered, measured) for name, answered in answers.items()},
        delta_e_spectra(light, answers["half the atlas"], measured),
        cube.standard_error(rgb),
    )


def _inside(spectra: Atlas, cube: Cube) -> Indices:
    """Rows of the entries that the cube's space holds."""
    sensor = cube.data.sensor
    rows = np.flatnonzero(sensor.contains(sensor.rgb(resample(spectra, sensor.wavelengths).values)))
    if len(rows) < FEWEST:
        raise AtlasError(
            f"{len(rows)} entries lie within {sensor.space}, too few to halve",
            hint=f"give an atlas of {FEWEST} or more",
        )
    return rows


def _some(spectra: Atlas, rows: Indices) -> Atlas:
    return Atlas(tuple(spectra.entries[row] for row in rows))


def pooled_calibration(splits: Sequence[HoldoutSplit]) -> Calibration | None:
    """Of all splits together. None where the cubes state no errors."""
    parts = [(split.real, split.stated) for split in splits if split.stated is not None]
    if not parts:
        return None
    real, stated = (np.concatenate(part) for part in zip(*parts, strict=True))
    return calibration(real, stated)
