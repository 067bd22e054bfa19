"""One mixture by every mixing model, as text or JSON."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from .console import emit, print_json
from .coordinates import coordinates
from .query_output import format_rgb, hex_code, patch

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.lookup import Cube

    from ..params.ingredients import Ingredient


def print_theories(cube: Cube, ingredients: list[Ingredient], method: str, style: str) -> None:
    """Mix the colours of the ingredients by every model of `uplift.design.mixing.mixers`, and print the results."""
    mixtures = _mixtures(cube, ingredients, method)
    if style == "json":
        rows = [
            {"theory": title, "rgb": rgb.tolist(), "hex": hex_code(cube, rgb), **coordinates(cube, rgb)}
            for title, rgb in mixtures.items()
        ]
        print_json({"names": [one.name for one in ingredients], "theories": rows}, indent=None)
        return
    for title, rgb in mixtures.items():
        swatch = f"{patch(cube, rgb)}  " if sys.stdout.isatty() else ""
        emit(f"{swatch}{hex_code(cube, rgb)}  {format_rgb(rgb)}  {title}")


def _mixtures(cube: Cube, ingredients: list[Ingredient], method: str) -> dict[str, Array]:
    """Linear RGB (3,) in [0, 1] by the title of the model."""
    import numpy as np

    from uplift.colorimetry.gamut import map_to_gamut
    from uplift.design.mixing import mixers

    sensor = cube.data.sensor
    spectra = np.stack([one.spectrum[: len(sensor.wavelengths)] for one in ingredients])
    rgb, parts = np.clip(sensor.rgb(spectra), 0, 1), np.array([one.parts for one in ingredients])
    return {mixer.title: map_to_gamut(mixer.mix(rgb, parts)[None], sensor, method).rgb[0] for mixer in mixers(cube)}
