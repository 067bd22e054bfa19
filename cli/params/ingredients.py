"""What is to be mixed, as it is typed: '2:#1f3a93', 'yellow', '1:0.2,0.1,0.6', '3:#c8342a/#5a120e'."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .colours import from_arguments

if TYPE_CHECKING:
    from uplift.atlas import Atlas
    from uplift.common.arrays import Array
    from uplift.design.mixing.recipes import Ingredients
    from uplift.lookup import Cube

PARTS = re.compile(r"\s*([0-9.+-][0-9.eE+-]*)\s*:(.*)", re.DOTALL)
NAMED = {"white": 1.0, "black": 0.0}
"""The perfect reflector, and nothing: the same at all wavelengths."""
REMEDY = "write '#rrggbb', 'r,g,b' in linear RGB, or an entry of the cube's atlas or of --atlas"


@dataclass(frozen=True, eq=False)
class Ingredient:
    """``parts`` of something with a spectrum (N,), and with a second one if it was seen on black too."""

    name: str
    parts: float
    spectrum: Array
    on_black: Array | None


@dataclass(frozen=True, eq=False)
class Shelf:
    """Where colours and names get their spectra at ``wavelengths`` (N,) from: a cube, and measured atlases."""

    cube: Cube
    atlas: Atlas
    wavelengths: Array

    def ingredients(self, words: Sequence[str]) -> list[Ingredient]:
        """Raises `ColourError` for what is no colour and no name, `OptionError` for parts that are no number."""
        return [self._ingredient(word.strip()) for word in words]

    def spectrum(self, text: str) -> Array:
        """(N,) of a colour, 'white', 'black' or an entry. Raises `ColourError`."""
        import numpy as np

        from uplift.atlas import Atlas as Atlas
        from uplift.atlas import on_grid

        if text in self.cube.data.atlas.names:
            return self._uplifted(self.cube.data.atlas.rgb[self.cube.data.atlas.names.index(text)])
        if text in self.atlas.names:
            entry = self.atlas.entries[self.atlas.names.index(text)]
            return on_grid(Atlas((entry,)), self.wavelengths)[0]
        if text in NAMED:
            return np.full(len(self.wavelengths), NAMED[text])
        return self._uplifted(self._colour(text))

    def knows(self, text: str) -> bool:
        return text in self.cube.data.atlas.names or text in self.atlas.names

    def _ingredient(self, word: str) -> Ingredient:
        parts, name = 1.0, word
        found = None if self.knows(word) else PARTS.match(word)
        if found:
            parts, name = _number(found[1], word), found[2].strip()
        if self.knows(name) or "/" not in name:
            return Ingredient(name, parts, self.spectrum(name), None)
        on_white, on_black = (half.strip() for half in name.split("/", 1))
        return Ingredient(name, parts, self.spectrum(on_white), self.spectrum(on_black))

    def _colour(self, text: str) -> Array:
        """Linear RGB (3,)."""
        from uplift.common.errors import ColourError

        try:
            return from_arguments([text], self.cube, codes=False)[0]
        except ColourError as error:
            raise ColourError(f"{error.problem} and no entry", hint=REMEDY) from error

    def _uplifted(self, rgb: Array) -> Array:
        return self.cube.reflectance(rgb, self.wavelengths)


def shelf_of(cube: Cube, atlases: tuple[str, ...], asked: Array) -> Shelf:
    """Spectra at the cube's wavelengths, which colours are told from, and at those asked for."""
    import numpy as np

    from uplift.atlas import Atlas, read_atlas

    at = np.concatenate([cube.data.sensor.wavelengths, asked])
    return Shelf(cube, read_atlas(*atlases) if atlases else Atlas(), at)


def given(ingredients: list[Ingredient], count: int | None = None) -> Ingredients:
    """As the library takes them, at the first ``count`` wavelengths."""
    import numpy as np

    from uplift.design.mixing.recipes import Ingredients

    return Ingredients(
        np.stack([one.spectrum[:count] for one in ingredients]),
        tuple(None if one.on_black is None else one.on_black[:count] for one in ingredients),
    )


def _number(text: str, word: str) -> float:
    from uplift.common.errors import OptionError

    try:
        parts = float(text)
    except ValueError:
        parts = 0.0
    if not 0 < parts < float("inf"):
        raise OptionError(f"'{word}' has parts that are no number above 0", hint="write '2:#1f3a93'")
    return parts
