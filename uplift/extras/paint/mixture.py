"""Mixtures in words: '2:#1f3a93', 'yellow', '1:0.2,0.1,0.6' or '3:#c8342a/#5a120e' are
ingredients with their parts.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas.atlas import Atlas, Entry
from uplift.colorimetry.gamut import map_to_gamut
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import ColourError, OptionError, UpliftWarning, warn
from uplift.common.text import format_value
from uplift.extras.files.csv import is_decimal, parse_decimal
from uplift.extras.paint.optics import Coat, Surface, add_lights, ramp, stack_filters
from uplift.extras.paint.paints import Paints
from uplift.extras.paint.pigments import Pigment, Scattering

# A mixture of measured paints loads no reader of colours and files.
if TYPE_CHECKING:
    from uplift.extras.colour.spaces import ImageSpace
    from uplift.lookup.cube import Cube

PARTS = re.compile(r"\s*([0-9.+-][0-9.,eE+-]*)\s*:(.*)", re.DOTALL)
CONSTANT_SPECTRA = {"white": 1.0, "black": 0.0}
"""The perfect reflector and the perfect absorber: the same value at all wavelengths."""

RAMP = 9
"""Swatches from the first ingredient to the last."""


class Components(Protocol):
    """Components of a coat."""

    def coat(self, parts: ArrayLike, thickness: float | None, surface: Surface) -> Coat:
        """Make a coat."""


def split_parts(word: str, entries: Sequence[str]) -> tuple[float, str]:
    """Return the parts that a word begins with, 1 without any, and the name. Raise
    `OptionError` for parts below 0.
    """
    name = word.strip()
    match = None if name in entries else PARTS.match(name)
    if match is None:
        return 1.0, name
    parts = parse_decimal(match[1]) if is_decimal(match[1]) else -1.0
    if not 0 <= parts < float("inf"):
        problem = f"parts must be a number of at least 0, got {format_value(word)}"
        raise OptionError(problem, hint="write for example '2:#1f3a93'")
    return parts, match[2].strip()


def read_entries(files: Sequence[str]) -> Atlas:
    """Return the entries of files, none without files."""
    if not files:
        return Atlas()
    from uplift.atlas.sources import read_atlas

    return read_atlas(*files)


def sample_entry(entry: Entry, wavelengths: Array) -> Array:
    """Return the spectrum (N,) of an atlas entry."""
    from uplift.atlas.resampling import on_grid

    return on_grid(Atlas((entry,)), wavelengths)[0]


@dataclass(frozen=True, eq=False)
class SpectrumResolver:
    """Spectra at ``wavelengths`` (N,) of colours, by a cube, and of named entries, by
    the cube and an atlas.

    Colours are in ``space``, or in that of the cube. Those outside [0, 1] are mapped
    into the gamut by ``method``.
    """

    cube: Cube
    atlas: Atlas
    wavelengths: Array
    space: ImageSpace | None = None
    method: str = "error"

    @property
    def entries(self) -> tuple[str, ...]:
        """Names of the entries."""
        return (*self.cube.data.atlas.names, *self.atlas.names)

    def spectrum(self, text: str) -> Array:
        """Return the spectrum (N,) of a colour, 'white', 'black' or an entry."""
        if text in self.entries:
            return self._entry(text)
        if text in CONSTANT_SPECTRA:
            return np.full(len(self.wavelengths), CONSTANT_SPECTRA[text])
        mapped = map_to_gamut(self._rgb(text), self.cube.data.sensor, self.method)
        if mapped.count:
            problem = (
                f"{format_value(text)} lies outside [0, 1]: mapped into the gamut "
                f"({self.method})"
            )
            warn(UpliftWarning(problem))
        return self.cube.reflectance(mapped.rgb, self.wavelengths)

    def _entry(self, name: str) -> Array:
        entries = self.cube.data.atlas
        if name in entries.names:
            rgb = entries.rgb[entries.names.index(name)]
            return self.cube.reflectance(rgb, self.wavelengths)
        return sample_entry(self.atlas[name], self.wavelengths)

    def _rgb(self, text: str) -> Array:
        """Return the linear RGB (3,) of a colour."""
        from uplift.extras.colour.colour_source import ColourSource

        source = ColourSource((text,), space=self.space)
        try:
            [(rgb,)] = source.blocks(self.cube.data.sensor)
        except ColourError as error:
            if error.code == "ambiguous-numbers":
                raise
            raise ColourError(
                f"{error.problem} and not an atlas entry",
                hint="write '#rrggbb', 'r,g,b' in linear RGB, or an atlas entry",
            ) from error
        return rgb


@dataclass(frozen=True, eq=False)
class Recipe:
    """Ingredients of a kind with their names and parts.

    ``spectra`` (n, N) are those of colours, of measured paints K and S (n, 2, N), and
    of Duntley's paints their constants (n, 6, N).
    """

    kind: str
    parts: tuple[float, ...]
    names: tuple[str, ...]
    spectra: Array
    on_black: tuple[Array | None, ...]

    @property
    def title(self) -> str:
        pairs = zip(self.parts, self.names, strict=True)
        return ", ".join(f"{amount:g} of {name}" for amount, name in pairs)

    @property
    def amounts(self) -> Array:
        """The parts, followed by those of the ramp."""
        return np.concatenate([[self.parts], ramp(self.parts, RAMP)])

    def components(self, law: Scattering, *, in_plate: bool = False) -> Components:
        """Return the components of a coat, by the class of their kind: S of pigments
        that are known by one colour follows a law, and dyes may be in a plate.
        """
        if self.kind == "measured":
            return Pigment(self.spectra[:, 0], self.spectra[:, 1])
        if self.kind == "duntley":
            from uplift.extras.paint.duntley import DuntleyPaints

            return DuntleyPaints(self.spectra)
        from uplift.extras.paint.coats import Dyes, Pigments, Plates

        if self.kind == "dye":
            return (Plates if in_plate else Dyes)(self.spectra)
        return Pigments(self.spectra, law, self.on_black)

    def sums(self) -> Array:
        """Return the transmittances of filters, or the powers of lights."""
        mix = stack_filters if self.kind == "filter" else add_lights
        return mix(self.spectra, self.amounts)


def read_recipe(
    resolver: SpectrumResolver, words: Sequence[str], kind: str, paints: Paints | None
) -> Recipe:
    """Return the recipe of words, at the wavelengths of the resolver."""
    rows = []
    for word in words:
        entries = resolver.entries if paints is None else paints.names
        parts, name = split_parts(word, () if kind == "duntley" else entries)
        on_black = None
        if kind == "duntley":
            from uplift.extras.paint.duntley import read_constants

            spectrum = read_constants(name, resolver.wavelengths)
        elif paints is not None:
            paint = paints.select([name]).at(resolver.wavelengths).pigments
            spectrum = np.concatenate([paint.absorption, paint.scattering])
        else:
            spectrum, *blacks = _colours(resolver, name, kind)
            on_black = blacks[0] if blacks else None
        rows.append((parts, name, spectrum, on_black))
    # What is not in a mixture has no place on its ramp either.
    rows = [row for row in rows if row[0] > 0] or rows
    amounts, names, spectra, on_blacks = zip(*rows, strict=True)
    return Recipe(kind, amounts, names, np.stack(spectra), on_blacks)


def _colours(resolver: SpectrumResolver, name: str, kind: str) -> list[Array]:
    """Return the spectrum of an ingredient, and that on black if it is given."""
    if name in resolver.entries or "/" not in name:
        return [resolver.spectrum(name)]
    if kind != "pigment":
        raise OptionError(
            f"{kind}s must not have a colour on black",
            hint="pass their colour on white only",
        )
    return [resolver.spectrum(part.strip()) for part in name.split("/", 1)]


@dataclass(frozen=True, eq=False)
class Mixture:
    """The mixture, followed by the ramp from its first to its last ingredient."""

    recipe: Recipe
    rgb: Array
    values: Array
    """Spectrum of the mixture at the wavelengths of the output."""


def display_mixture(
    recipe: Recipe, cube: Cube, sensor: Sensor, mixed: Array, method: str
) -> Mixture:
    """Return the colours of mixed spectra (n, N), whose first samples are those of the
    sensor, in the gamut.
    """
    count = len(sensor.wavelengths)
    rgb = sensor.rgb(mixed[:, :count])
    inside = np.clip(rgb, 0, 1)
    rounded = np.abs(rgb - inside).max(axis=1, keepdims=True) <= cube.data.threshold
    mapped = map_to_gamut(np.where(rounded, inside, rgb), sensor, method)
    if mapped.outside[0]:
        problem = f"the mixture lies outside [0, 1]: mapped into the gamut ({method})"
        warn(UpliftWarning(problem))
    return Mixture(recipe, mapped.rgb, mixed[0, count:])
