"""Measured samples of paint with known parts, from a table or with a table of recipes.

A row of a table is a sample. Columns with the names of paints hold parts, the columns
``thickness`` and ``ground`` describe films, and either columns of wavelengths hold
reflectances or a column ``colour`` holds a code ``#rrggbb``. A row without parts is a
ground that others name.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from uplift.atlas.atlas import VISIBLE, Atlas
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Mask, StrPath
from uplift.common.errors import unknown_name
from uplift.common.text import format_value
from uplift.extras.colour.srgb import HEX, decode
from uplift.extras.paint.recipe_table import Recipe, RecipeTable, read_recipes

GROUNDS = {"white": 1.0, "black": 0.0}
"""Reflectances of grounds that need no sample."""
RANGE = (380.0, 780.0)
"""Wavelengths in nm that are used."""
STEP = 10.0
"""Step in nm where the file has no even one, or only colours."""
STEPS = (5.0, 20.0)
"""Smallest and largest step in nm that are kept."""
EVEN = 1e-6
"""Tolerance of even steps in nm."""


@dataclass(frozen=True)
class Noise:
    """Standard deviation of measured values: of all, and relative to the value."""

    absolute: float
    relative: float

    def spread(self, values: Array) -> Array:
        """Return the standard deviation of values."""
        return np.hypot(self.absolute, self.relative * values)


@dataclass(frozen=True, eq=False)
class MeasuredSpectra:
    """Reflectances (n, N) of samples."""

    values: Array
    noise: ClassVar = Noise(0.002, 0.005)
    """Smallest noise of reflectances."""

    def rgb(self, sensor: Sensor) -> Array:
        """Return linear sRGB (n, 3)."""
        return np.clip(sensor.rgb(self.values), 0, 1)


@dataclass(frozen=True, eq=False)
class MeasuredColours:
    """Linear sRGB (n, 3) of samples whose reflectances are not known."""

    values: Array
    noise: ClassVar = Noise(0.5, 0.0)
    """Smallest noise of L*, a* and b*."""

    def rgb(self, sensor: Sensor) -> Array:
        """Return linear sRGB (n, 3)."""
        return self.values


Measured = MeasuredSpectra | MeasuredColours


@dataclass(frozen=True, eq=False)
class PaintSamples:
    """Samples of P paints, with their spectra or else their colours.

    Parameters
    ----------
    names : tuple of str
        Names of the n samples.
    paints : tuple of str
        Names of the paints.
    shares : ndarray, shape (n, P)
        Shares of the paints, of sum 1.
    thickness : ndarray, shape (n,)
        Thickness of films, infinite for opaque samples.
    grounds : ndarray, shape (n, N)
        Reflectance of the ground below each film.
    wavelengths : ndarray, shape (N,)
        Wavelengths in nm.
    measured : MeasuredSpectra or MeasuredColours
        What was measured of the n samples.
    notes : tuple of str
        How the table was understood: which columns are not used.
    """

    names: tuple[str, ...]
    paints: tuple[str, ...]
    shares: Array
    thickness: Array
    grounds: Array
    wavelengths: Array
    measured: Measured
    notes: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.names)

    @property
    def is_opaque(self) -> Mask:
        """Whether each sample (n,) hides its ground."""
        return np.isinf(self.thickness)

    @property
    def unmixed(self) -> list[str]:
        """Paints that one opaque sample has, and none of their mixtures."""
        alone = (self.shares > 0).sum(axis=0) == 1
        pure = self.is_opaque[:, None] & (self.shares == 1)
        return np.array(self.paints)[alone & pure.any(axis=0)].tolist()


def read_paint_samples(path: StrPath, recipes: StrPath | None = None) -> PaintSamples:
    """Read measured samples of paint.

    Parameters
    ----------
    path : path-like
        Measured spectra in any format that atlases have, or a table with a column
        ``colour``.
    recipes : path-like, optional
        Table of the parts, by the names of the samples; by default ``path``.

    Returns
    -------
    PaintSamples
        The samples, with spectra at the wavelengths of the file from 380 to 780 nm.

    Raises
    ------
    AtlasError
        A file cannot be read, names no paints, or a value in it is invalid.
    """
    table = read_recipes(path if recipes is None else recipes)
    has_colours = any(recipe.colour for recipe in table.recipes)
    if has_colours and recipes is None and not table.has_spectra:
        return _coloured_samples(table)
    atlas = read_atlas(path)
    by_name = {recipe.name: recipe for recipe in table.recipes}
    unknown = [entry.name for entry in atlas if entry.name not in by_name]
    if len(unknown) == len(atlas):
        raise table.location.error(
            f"no recipe has the name of a measured sample, such as "
            f"{format_value(unknown[0])}",
            "give samples the same names in both files",
            code="recipe-without-sample",
        )
    entries = [entry for entry in atlas if entry.name in by_name]
    wavelengths = _common_grid(atlas)
    spectra = on_grid(Atlas(tuple(entries)), wavelengths)
    kept = [by_name[entry.name] for entry in entries]
    backings = {
        recipe.name: spectrum
        for recipe, spectrum in zip(kept, spectra, strict=True)
        if recipe.is_ground
    }
    rows = [row for row, recipe in enumerate(kept) if not recipe.is_ground]
    painted = [kept[row] for row in rows]
    measured = MeasuredSpectra(spectra[rows])
    return _samples(table, painted, wavelengths, backings, measured)


def _coloured_samples(table: RecipeTable) -> PaintSamples:
    wavelengths = np.arange(400.0, 700 + STEP / 2, STEP)
    painted = [recipe for recipe in table.recipes if not recipe.is_ground]
    colours = []
    for recipe in painted:
        if not HEX.fullmatch(recipe.colour):
            raise table.location.at(recipe.line, recipe.name).error(
                f"colour must be '#rrggbb', got {format_value(recipe.colour)}",
                "write '#cc3319'",
            )
        colours.append(list(bytes.fromhex(recipe.colour[1:])))
    measured = MeasuredColours(decode(np.array(colours).reshape(-1, 3) / 255))
    return _samples(table, painted, wavelengths, {}, measured)


def _samples(
    table: RecipeTable,
    recipes: Sequence[Recipe],
    wavelengths: Array,
    backings: dict[str, Array],
    measured: Measured,
) -> PaintSamples:
    if not recipes:
        raise table.location.error(
            "no sample has a paint", "write the parts in columns named as the paints"
        )
    parts = np.array([recipe.parts for recipe in recipes])
    used = parts.any(axis=0)
    known = {name: np.full_like(wavelengths, value) for name, value in GROUNDS.items()}
    known |= backings
    grounds = []
    for recipe in recipes:
        if recipe.ground not in known:
            error = unknown_name(recipe.ground, known, "ground")
            location = table.location.at(recipe.line, recipe.name)
            raise location.error(error.problem, error.hint)
        grounds.append(known[recipe.ground])
    paints = np.array(table.paints)[used]
    return PaintSamples(
        tuple(recipe.name for recipe in recipes),
        tuple(paints.tolist()),
        parts[:, used] / parts.sum(axis=1, keepdims=True),
        np.array([recipe.thickness for recipe in recipes]),
        np.array(grounds),
        wavelengths,
        measured,
        table.notes,
    )


def _common_grid(atlas: Atlas) -> Array:
    """Return evenly spaced wavelengths in the range that all entries have, in the step
    of the coarsest one, or in `STEP` if it has none of `STEPS`.
    """
    first = max(RANGE[0], *(entry.wavelengths[0] for entry in atlas))
    last = min(RANGE[1], *(entry.wavelengths[-1] for entry in atlas))
    coarsest = min(atlas, key=lambda entry: len(entry.wavelengths))
    nm = np.asarray(coarsest.wavelengths)
    inside = nm[(nm >= first) & (nm <= last)]
    steps = np.diff(inside)
    is_even = np.ptp(steps) < EVEN and STEPS[0] <= steps[0] <= STEPS[1]
    if is_even and inside[0] <= VISIBLE[0] and inside[-1] >= VISIBLE[1]:
        return inside
    # Entries cover the visible range but for rounding.
    start = np.ceil(min(first, VISIBLE[0]) / STEP) * STEP
    return np.arange(start, max(last, VISIBLE[1]) + EVEN, STEP)
