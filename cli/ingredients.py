"""Ingredients of a mixture: '2:#1f3a93', 'yellow', '1:0.2,0.1,0.6' or
'3:#c8342a/#5a120e'.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from uplift.common.errors import ColourError, OptionError, UpliftWarning
from uplift.common.text import format_value
from uplift.extras.files.csv import is_decimal, parse_decimal

from .output.diagnostics import warn

if TYPE_CHECKING:
    from uplift.atlas.atlas import Atlas, Entry
    from uplift.common.arrays import Array
    from uplift.extras.colour.spaces import ImageSpace
    from uplift.lookup.cube import Cube

PARTS = re.compile(r"\s*([0-9.+-][0-9.,eE+-]*)\s*:(.*)", re.DOTALL)
CONSTANT_SPECTRA = {"white": 1.0, "black": 0.0}
"""The perfect reflector and the perfect absorber: the same value at all wavelengths."""


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
    from uplift.atlas.atlas import Atlas

    if not files:
        return Atlas()
    from uplift.atlas.sources import read_atlas

    return read_atlas(*files)


def sample_entry(entry: Entry, wavelengths: Array) -> Array:
    """Return the spectrum (N,) of an atlas entry."""
    from uplift.atlas.atlas import Atlas
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
        import numpy as np

        if text in self.entries:
            return self._entry(text)
        if text in CONSTANT_SPECTRA:
            return np.full(len(self.wavelengths), CONSTANT_SPECTRA[text])
        from uplift.colorimetry.gamut import map_to_gamut

        mapped = map_to_gamut(self._rgb(text), self.cube.data.sensor, self.method)
        if mapped.count:
            problem = (
                f"{format_value(text)} lies outside [0, 1]: mapped into the gamut "
                f"({self.method})"
            )
            warn([UpliftWarning(problem)])
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
            hint = (
                "write '#rrggbb', 'r,g,b' in linear RGB, or an entry of the cube's "
                "atlas or of --atlas"
            )
            raise ColourError(
                f"{error.problem} and not an atlas entry", hint=hint
            ) from error
        return rgb
