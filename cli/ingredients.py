"""Ingredients of a mixture: '2:#1f3a93', 'yellow', '1:0.2,0.1,0.6' or '3:#c8342a/#5a120e'."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from uplift.common.errors import ColourError, OptionError
from uplift.common.text import format_value, parse_float

from .colours import ColourReader

if TYPE_CHECKING:
    from uplift.atlas import Atlas
    from uplift.colorimetry.spaces import ImageSpace
    from uplift.common.arrays import Array
    from uplift.design.mixing.coats import Ingredients
    from uplift.lookup import Cube

PARTS = re.compile(r"\s*([0-9.+-][0-9.eE+-]*)\s*:(.*)", re.DOTALL)
CONSTANT_SPECTRA = {"white": 1.0, "black": 0.0}
"""The perfect reflector and the perfect absorber: the same value at all wavelengths."""


@dataclass(frozen=True, eq=False)
class Ingredient:
    """``parts`` of a colour with a spectrum (N,), and its spectrum on black (N,) if one is given."""

    name: str
    parts: float
    spectrum: Array
    on_black: Array | None


@dataclass(frozen=True, eq=False)
class SpectrumResolver:
    """Spectra at ``wavelengths`` (N,) of colours, by a cube, and of named entries, by the cube and an atlas.

    Colours are in ``space``, or in that of the cube.
    """

    cube: Cube
    atlas: Atlas
    wavelengths: Array
    space: ImageSpace | None = None

    def ingredients(self, words: Sequence[str]) -> list[Ingredient]:
        """Parse ingredients. Raises `ColourError` for unknown names, `OptionError` for parts that are not positive."""
        return [self._ingredient(word.strip()) for word in words]

    def spectrum(self, text: str) -> Array:
        """Return the spectrum (N,) of a colour, 'white', 'black' or an entry. Raises `ColourError`."""
        import numpy as np

        from uplift.atlas import Atlas, on_grid

        entries = self.cube.data.atlas
        if text in entries.names:
            return self._uplift(entries.rgb[entries.names.index(text)])
        if text in self.atlas.names:
            entry = self.atlas.entries[self.atlas.names.index(text)]
            return on_grid(Atlas((entry,)), self.wavelengths)[0]
        if text in CONSTANT_SPECTRA:
            return np.full(len(self.wavelengths), CONSTANT_SPECTRA[text])
        reader = ColourReader(self.cube.data.sensor, space=self.space)
        try:
            rgb = reader.parse([text])[0]
        except ColourError as error:
            hint = "write '#rrggbb', 'r,g,b' in linear RGB, or an entry of the cube's atlas or of --atlas"
            raise ColourError(f"{error.problem} and not an atlas entry", hint=hint) from error
        return self._uplift(rgb)

    def _is_entry(self, text: str) -> bool:
        return text in self.cube.data.atlas.names or text in self.atlas.names

    def _ingredient(self, word: str) -> Ingredient:
        parts, name = 1.0, word
        match = None if self._is_entry(word) else PARTS.match(word)
        if match:
            parts, name = _positive(match[1], word), match[2].strip()
        if self._is_entry(name) or "/" not in name:
            return Ingredient(name, parts, self.spectrum(name), None)
        on_white, on_black = (half.strip() for half in name.split("/", 1))
        return Ingredient(name, parts, self.spectrum(on_white), self.spectrum(on_black))

    def _uplift(self, rgb: Array) -> Array:
        return self.cube.reflectance(rgb, self.wavelengths)


def make_resolver(
    cube: Cube, atlases: tuple[str, ...], wavelengths: Array, space: ImageSpace | None = None
) -> SpectrumResolver:
    """Resolve spectra at the wavelengths of the cube's sensor, for colours, followed by ``wavelengths``, for output."""
    import numpy as np

    from uplift.atlas import Atlas, read_atlas

    grid = np.concatenate([cube.data.sensor.wavelengths, wavelengths])
    return SpectrumResolver(cube, read_atlas(*atlases) if atlases else Atlas(), grid, space)


def library_ingredients(ingredients: list[Ingredient], count: int | None = None) -> Ingredients:
    """Convert to the library's type, at the first ``count`` wavelengths."""
    import numpy as np

    from uplift.design.mixing.coats import Ingredients

    return Ingredients(
        np.stack([one.spectrum[:count] for one in ingredients]),
        tuple(None if one.on_black is None else one.on_black[:count] for one in ingredients),
    )


def _positive(text: str, word: str) -> float:
    try:
        parts = parse_float(text)
    except ValueError:
        parts = 0.0
    if not 0 < parts < float("inf"):
        problem = f"parts must be a number above 0, got {format_value(word)}"
        raise OptionError(problem, hint="write for example '2:#1f3a93'")
    return parts
