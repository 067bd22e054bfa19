"""Mixtures of ``uplift paints mix``, printed and drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .output.answers import (
    as_lists,
    coordinates,
    describe_coordinates,
    format_rgb,
    hex_code,
    patch,
    print_spectrum,
)
from .output.console import print_json
from .output.table import Format, Table, swatch

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.extras.paint.mixture import Mixture, Recipe
    from uplift.lookup.cube import Cube

MIXTURE_MAPPING = "scale"
"""How mixtures are mapped into the gamut: it keeps the hue of bright ones."""


def coloured(code: str) -> Any:
    """Return a cell with the code of a colour and a patch of it."""
    return swatch(code, code)


def plot_ramp(mixture: Mixture, cube: Cube, path: str, *, force: bool) -> None:
    from uplift.extras.colour.srgb import to_display_codes
    from uplift.extras.pages.plots import plot_strips

    recipe = mixture.recipe
    codes = to_display_codes(mixture.rgb, cube.data.sensor) / 255
    strips = {f"{recipe.kind}: {recipe.title}": codes[:1]}
    if len(recipe.names) > 1:
        strips[f"from {recipe.names[0]} to {recipe.names[-1]}"] = codes[1:]
    plot_strips(strips, path, force=force)


def print_mixture(
    mixture: Mixture, cube: Cube, wavelengths: Array, style: str, *, complete: bool
) -> None:
    recipe = mixture.recipe
    colour, *steps = [
        {"parts": parts.tolist(), **_colour(cube, rgb)}
        for parts, rgb in zip(recipe.amounts, mixture.rgb, strict=True)
    ]
    if style == "json":
        answer = {
            "kind": recipe.kind,
            "names": recipe.names,
            **colour,
            "wavelengths": wavelengths.tolist(),
            "spectrum": as_lists(mixture.values),
            "ramp": steps,
        }
        print_json(answer, indent=None)
        return
    fields = {
        recipe.kind: recipe.title,
        "linear RGB": f"{format_rgb(mixture.rgb[0])}  {colour['hex']}",
        **describe_coordinates(colour),
    }
    if steps:
        fields["ramp"] = " ".join(step["hex"] for step in steps)
    patches = {
        "linear RGB": patch(cube, mixture.rgb[0]),
        "ramp": "".join(patch(cube, rgb, 4) for rgb in mixture.rgb[1:]),
    }
    print_spectrum(
        fields,
        wavelengths,
        mixture.values,
        complete=complete,
        patches=patches,
        highest=max(1, mixture.values.max()),
    )


def print_theories(recipe: Recipe, cube: Cube, method: str, style: str) -> None:
    import numpy as np

    from uplift.colorimetry.gamut import map_to_gamut
    from uplift.extras.paint.theories import mixers

    sensor = cube.data.sensor
    rgb = np.clip(sensor.rgb(recipe.spectra), 0, 1)
    rows = []
    for title, mix in mixers(cube).items():
        mixed = mix(rgb, np.array(recipe.parts))[None]
        colour = map_to_gamut(mixed, sensor, method).rgb[0]
        rows.append({"theory": title, **_colour(cube, colour)})
    headings = {"theory": "theory", "hex": "hex", "rgb": "linear RGB"}
    formats: dict[str, Format] = {"hex": coloured, "rgb": ".6f"}
    table = Table(rows, headings, formats=formats)
    if style == "json":
        print_json({"names": recipe.names, "theories": rows}, indent=None)
    else:
        table.print_text()


def _colour(cube: Cube, rgb: Array) -> dict[str, Any]:
    return {"rgb": as_lists(rgb), "hex": hex_code(cube, rgb), **coordinates(cube, rgb)}
