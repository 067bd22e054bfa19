"""Libraries of a build: measured spectra that shape the prior, as families."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from uplift import fit
from uplift.atlas import Atlas, read_atlas, resample
from uplift.colorimetry.observer import grid
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import StrPath
from uplift.common.errors import OptionError, UpliftWarning
from uplift.pipeline.options import Options

SPREAD, RELATED = 1.0, 0.5
"""See `uplift.fit.Family`; by held-out halves of large sets (docs/prior.md)."""
STACK_LEVEL = 5
"""Frames between a warning and the caller of `build`, whose decorator adds two."""

AtlasLike = Atlas | StrPath | Sequence[StrPath] | None


@dataclass(frozen=True)
class Library:
    """Spectra of one file, or given as an atlas.

    Parameters
    ----------
    name : str
        Name of the file.
    digest : str
        SHA-256 of its bytes; empty for spectra without a file.
    atlas : Atlas
        The spectra.
    """

    name: str
    digest: str
    atlas: Atlas


def read_libraries(library: AtlasLike) -> tuple[Library, ...]:
    """Read libraries, a family per file."""
    if library is None:
        return ()
    if isinstance(library, Atlas):
        return (_library(library),)
    paths = [library] if isinstance(library, str | os.PathLike) else library
    return tuple(_library(read_atlas(path)) for path in paths)


def _library(atlas: Atlas) -> Library:
    if len(atlas.sources) != 1:
        return Library("library", "", atlas)
    return Library(atlas.sources[0].name, atlas.sources[0].digest, atlas)


def families(options: Options, libraries: Sequence[Library], sensor: Sensor) -> tuple[fit.Family, ...]:
    """Return the families that shape the prior: the shipped library, then those of the user.

    Warns of each library that is not used as measured. Raises `OptionError` (``library-not-used``) for libraries
    without a learnt prior.
    """
    learnt = options.prior == "learnt" and fit.has_freedom(options.spectrum_model())
    if libraries and not learnt:
        raise OptionError(
            "a library shapes only the learnt prior of models with more than three coefficients",
            code="library-not-used",
            hint='use prior="learnt" and the moments model with 4 to 17 coefficients, or leave out the library',
        )
    shipped = [_on_range(family, sensor) for family in fit.shipped_library(options.leave_out)]
    if not learnt:
        return ()
    return (*shipped, *(_family(each, sensor) for each in libraries))


def _on_range(family: fit.Family, sensor: Sensor) -> fit.Family:
    """Interpolate a shipped family at the wavelengths of a sensor; outside 380–780 nm it is constant."""
    if np.array_equal(sensor.wavelengths, grid()):
        return family
    measured = np.array([np.interp(sensor.wavelengths, grid(), row) for row in family.measured])
    return replace(family, measured=measured)


def _family(library: Library, sensor: Sensor) -> fit.Family:
    resampled = resample(library.atlas, sensor.wavelengths)
    outside = int((~sensor.contains(sensor.rgb(resampled.values))).sum())
    if resampled.clips:
        problem = f"clipped to [0, 1]: {len(resampled.clips)} spectra, first '{resampled.clips[0].name}'"
        _warn(library, problem, "library-clipped")
    if outside:
        problem = f"{outside} of {len(resampled.values)} spectra not used: their colours lie outside {sensor.space}"
        _warn(library, problem, "library-out-of-gamut")
    return fit.Family(library.name, resampled.values, SPREAD, RELATED)


def _warn(library: Library, problem: str, code: str) -> None:
    warnings.warn(UpliftWarning(f"library '{library.name}': {problem}", code=code), stacklevel=STACK_LEVEL)


def describe(libraries: Sequence[Library], used: Sequence[fit.Family], relevance: Sequence[float]) -> dict[str, Any]:
    """Return the libraries and the relevance of the families, in JSON values."""
    return {
        "libraries": [{"name": library.name, "digest": library.digest} for library in libraries],
        "families": [{"name": family.name, "relevance": value} for family, value in zip(used, relevance, strict=True)],
    }
