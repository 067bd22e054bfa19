"""Ingredients of a mixture: '2:#1f3a93', 'yellow', '1:0.2,0.1,0.6' or
'3:#c8342a/#5a120e'.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from uplift.common.errors import ColourError, OptionError, UpliftWarning
from uplift.common.text import format_value
from uplift.extras.files.csv import is_decimal, parse_decimal

from .output.diagnostics import warn

if TYPE_CHECKING:
    from uplift.atlas.atlas import Atlas
    from uplift.colorimetry.sensor import Sensor
    from uplift.common.arrays import Array
    from uplift.extras.colour.spaces import ImageSpace
    from uplift.extras.paint.paints import Paints
    from uplift.lookup.cube import Cube

PARTS = re.compile(r"\s*([0-9.+-][0-9.,eE+-]*)\s*:(.*)", re.DOTALL)
CONSTANT_SPECTRA = {"white": 1.0, "black": 0.0}
"""The perfect reflector and the perfect absorber: the same value at all wavelengths."""


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
    paints: Paints | None = None
    """Measured paints, at other wavelengths."""
    sensor: Sensor | None = None
    """Sensor of the mixture, by default that of the cube."""

    def ingredient(
        self, word: str, kind: str = "pigment"
    ) -> tuple[str, float, Array, Array | None]:
        """Return name, parts, spectrum (N,), and spectrum on black (N,) if one is
        given.

        Of the kind 'duntley' the name is a file of constants, which replace the
        spectrum (6, N), and of the kind 'measured' that of a paint, with K and S
        (2, N). Raises `ColourError` for unknown names, `OptionError` for parts
        below 0, `AtlasError` for files.
        """
        import numpy as np

        from uplift.extras.paint.duntley import read_constants

        entries: tuple[str, ...] = ()
        if self.paints is not None:
            entries = self.paints.names
        elif kind != "duntley":
            entries = (*self.cube.data.atlas.names, *self.atlas.names)
        parts = 1.0
        name = word.strip()
        match = None if name in entries else PARTS.match(name)
        if match:
            parts = _parse_parts(match[1], word)
            name = match[2].strip()
        if kind == "duntley":
            return name, parts, read_constants(name, self.wavelengths), None
        if self.paints is not None:
            paint = self.paints.select([name]).at(self.wavelengths).pigments
            constants = np.concatenate([paint.absorption, paint.scattering])
            return name, parts, constants, None
        if name in entries or "/" not in name:
            return name, parts, self.spectrum(name), None
        on_white, on_black = (
            self.spectrum(half.strip()) for half in name.split("/", 1)
        )
        return name, parts, on_white, on_black

    def spectrum(self, text: str) -> Array:
        """Return the spectrum (N,) of a colour, 'white', 'black' or an entry."""
        import numpy as np

        from uplift.atlas.atlas import Atlas
        from uplift.atlas.resampling import on_grid
        from uplift.colorimetry.gamut import map_to_gamut
        from uplift.extras.colour.colour_source import ColourSource

        entries = self.cube.data.atlas
        if text in entries.names:
            return self.cube.reflectance(
                entries.rgb[entries.names.index(text)], self.wavelengths
            )
        if text in self.atlas.names:
            entry = self.atlas.entries[self.atlas.names.index(text)]
            return on_grid(Atlas((entry,)), self.wavelengths)[0]
        if text in CONSTANT_SPECTRA:
            return np.full(len(self.wavelengths), CONSTANT_SPECTRA[text])
        try:
            [(rgb,)] = ColourSource((text,), space=self.space).blocks(
                self.cube.data.sensor
            )
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
        mapped = map_to_gamut(rgb, self.cube.data.sensor, self.method)
        if mapped.count:
            problem = (
                f"{format_value(text)} lies outside [0, 1]: mapped into the gamut "
                f"({self.method})"
            )
            warn([UpliftWarning(problem)])
        return self.cube.reflectance(mapped.rgb, self.wavelengths)


def _parse_parts(text: str, word: str) -> float:
    parts = parse_decimal(text) if is_decimal(text) else -1.0
    if not 0 <= parts < float("inf"):
        problem = f"parts must be a number of at least 0, got {format_value(word)}"
        raise OptionError(problem, hint="write for example '2:#1f3a93'")
    return parts
