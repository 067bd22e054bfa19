"""Atlas entries of a build: those in gamut, as measured, and warnings of them."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass

import numpy as np

from uplift import fit
from uplift.atlas import Atlas, on_grid, read_atlas, resample
from uplift.colorimetry.observer import grid
from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.spaces import holding_note
from uplift.common.arrays import Array
from uplift.common.errors import UpliftWarning
from uplift.models import Model
from uplift.pipeline.libraries import AtlasLike
from uplift.pipeline.setting import Setting

STACK_LEVEL = 5
"""Frames between a warning and the caller of `uplift.build`, whose decorator adds two."""


@dataclass(frozen=True, eq=False)
class MeasuredEntries:
    """Entries of an atlas.

    Parameters
    ----------
    names : tuple of str
        Their E names.
    rgb : ndarray, shape (E, 3)
        Linear RGB in [0, 1].
    reflectances : ndarray, shape (E, N)
        Reflectances in [0, 1] at the wavelengths of the sensor.
    """

    names: tuple[str, ...]
    rgb: Array
    reflectances: Array

    def __len__(self) -> int:
        return len(self.names)

    def fit(self, setting: Setting, model: Model) -> fit.FittedEntries:
        """Fit the reflectances by a spectrum model; see `uplift.fit.fit_entries`."""
        return fit.fit_entries(
            model,
            setting.forward_of(model),
            self.reflectances,
            self.rgb,
            setting.lights,
            setting.error_light,
            setting.tolerance,
            solver=setting.solver,
        )


def as_atlas(atlas: AtlasLike) -> Atlas:
    """Return an atlas as given, or read from one file or several."""
    if atlas is None:
        return Atlas()
    if isinstance(atlas, Atlas):
        return atlas
    return read_atlas(atlas) if isinstance(atlas, str | os.PathLike) else read_atlas(*atlas)


def entries_in_gamut(atlas: Atlas, sensor: Sensor) -> MeasuredEntries:
    """Return the entries whose colours lie within the RGB space, with a warning for each other.

    Parameters
    ----------
    atlas : Atlas
        Measured spectra.
    sensor : Sensor
        Sensor of the cube.

    Returns
    -------
    MeasuredEntries

    Warns
    -----
    UpliftWarning
        An entry out of gamut (code ``entry-out-of-gamut``).
    """
    measured = on_grid(atlas, sensor.wavelengths)
    rgb = sensor.rgb(measured)
    inside = sensor.contains(rgb)
    way_out = "" if inside.all() else f"; {_holding_note(atlas, sensor)}"
    for row in np.flatnonzero(~inside):
        values = ", ".join(f"{value:.4f}" for value in rgb[row])
        warn(
            f"left out: its colour must lie within {sensor.space}, got linear RGB ({values}){way_out}",
            "entry-out-of-gamut",
            atlas.names[row],
        )
    names = tuple(name for name, kept in zip(atlas.names, inside, strict=True) if kept)
    return MeasuredEntries(names, np.clip(rgb[inside], 0, 1), measured[inside])


def _holding_note(atlas: Atlas, sensor: Sensor) -> str:
    return holding_note(resample(atlas, grid()).values, sensor.illuminant, sensor.observer)


def warn(problem: str, code: str, entry: str | None = None, hint: str = "") -> None:
    """Warn the caller of `uplift.build` from a function that `build` calls."""
    warnings.warn(UpliftWarning(problem, code=code, entry=entry, hint=hint), stacklevel=STACK_LEVEL)
