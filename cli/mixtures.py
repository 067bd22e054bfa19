"""Recipes of ``uplift mix``, their mixtures and ramps, as pictures, JSON and tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from uplift.common.errors import UpliftWarning

from .ingredients import SpectrumResolver
from .output.answers import (
    as_lists,
    coordinates,
    describe_coordinates,
    format_rgb,
    hex_code,
    patch,
    print_spectrum,
)
from .output.console import has_colours, make_table, print_json, show
from .output.diagnostics import warn

if TYPE_CHECKING:
    from uplift.colorimetry.sensor import Sensor
    from uplift.common.arrays import Array
    from uplift.extras.paint.coats import Ingredients, Medium
    from uplift.lookup.cube import Cube

MIXTURE_MAPPING = "scale"
"""How mixtures are mapped into the gamut: it keeps the hue of bright ones."""


@dataclass(frozen=True, eq=False)
class Recipe:
    """Ingredients with their names and parts."""

    cube: Cube
    sensor: Sensor
    kind: str
    names: Sequence[str]
    parts: tuple[float, ...]
    ingredients: Ingredients

    @property
    def title(self) -> str:
        pairs = zip(self.parts, self.names, strict=True)
        return ", ".join(f"{amount:g} of {name}" for amount, name in pairs)


def read_recipe(resolver: SpectrumResolver, words: Sequence[str], kind: str) -> Recipe:
    import numpy as np

    from uplift.extras.paint.coats import Ingredients

    ingredients = [resolver.ingredient(word, kind) for word in words]
    # What is not in a mixture has no place on its ramp either.
    ingredients = [row for row in ingredients if row[1] > 0] or ingredients
    names, parts, spectra, on_black = zip(*ingredients, strict=True)
    stacked = Ingredients(np.stack(spectra), on_black)
    sensor = resolver.sensor or resolver.cube.data.sensor
    return Recipe(resolver.cube, sensor, kind, names, parts, stacked)


@dataclass(frozen=True, eq=False)
class Mixture:
    """The mixture, followed by the ramp from its first to its last ingredient."""

    rgb: Array
    colours: list[dict[str, Any]]
    values: Array
    """Spectrum of the mixture at the wavelengths of the output."""


def mix_ramp(
    recipe: Recipe, medium: Medium, backing: Array | None, steps: int, method: str
) -> Mixture:
    """Mix on a backing; without, return the light that a plate transmits."""
    import numpy as np

    from uplift.colorimetry.gamut import map_to_gamut
    from uplift.extras.paint.coats import make_coat, mix, ramp

    cube = recipe.cube
    sensor = recipe.sensor
    parts = recipe.parts
    amounts = np.concatenate([np.array(parts)[None], ramp(parts, steps)])
    if backing is None:
        coat = make_coat(recipe.kind, recipe.ingredients, amounts, medium)
        mixed = coat.layer.transmittance
    else:
        mixed = mix(recipe.kind, recipe.ingredients, amounts, medium, backing)
    count = len(sensor.wavelengths)
    rgb = sensor.rgb(mixed[:, :count])
    inside = np.clip(rgb, 0, 1)
    rounded = np.abs(rgb - inside).max(axis=1, keepdims=True) <= cube.data.threshold
    mapped = map_to_gamut(np.where(rounded, inside, rgb), sensor, method)
    if mapped.outside[0]:
        problem = f"the mixture lies outside [0, 1]: mapped into the gamut ({method})"
        warn([UpliftWarning(problem)])
    colours = [
        {"parts": row.tolist(), **_colour(cube, colour)}
        for row, colour in zip(amounts, mapped.rgb, strict=True)
    ]
    return Mixture(mapped.rgb, colours, mixed[0, count:])


def plot_ramp(recipe: Recipe, mixture: Mixture, path: str, *, force: bool) -> None:
    from uplift.extras.colour.srgb import to_display_codes
    from uplift.extras.pages.plots import plot_strips

    names = recipe.names
    codes = to_display_codes(mixture.rgb, recipe.cube.data.sensor) / 255
    strips = {f"{recipe.kind}: {recipe.title}": codes[:1]}
    if len(names) > 1:
        strips[f"from {names[0]} to {names[-1]}"] = codes[1:]
    plot_strips(strips, path, force=force)


def print_mixture_json(recipe: Recipe, mixture: Mixture, wavelengths: Array) -> None:
    answer = {
        "kind": recipe.kind,
        "names": recipe.names,
        **mixture.colours[0],
        "wavelengths": wavelengths.tolist(),
        "spectrum": as_lists(mixture.values),
        "ramp": mixture.colours[1:],
    }
    print_json(answer, indent=None)


def print_mixture_table(
    recipe: Recipe, mixture: Mixture, wavelengths: Array, *, complete: bool
) -> None:
    cube = recipe.cube
    colour = mixture.colours[0]
    fields = {
        recipe.kind: recipe.title,
        "linear RGB": f"{format_rgb(mixture.rgb[0])}  {colour['hex']}",
    }
    fields |= describe_coordinates(colour)
    if len(recipe.names) > 1:
        fields["ramp"] = " ".join(step["hex"] for step in mixture.colours[1:])
    print_spectrum(
        fields,
        wavelengths,
        mixture.values,
        complete=complete,
        patches={
            "linear RGB": patch(cube, mixture.rgb[0]),
            "ramp": "".join(patch(cube, rgb, 4) for rgb in mixture.rgb[1:]),
        },
        highest=max(1, mixture.values.max()),
    )


def print_theories(recipe: Recipe, method: str, style: str) -> None:
    import numpy as np
    from rich.text import Text

    from uplift.colorimetry.gamut import map_to_gamut
    from uplift.extras.paint.theories import mixers

    cube = recipe.cube
    sensor = cube.data.sensor
    rgb = np.clip(sensor.rgb(recipe.ingredients.spectra), 0, 1)
    parts = np.array(recipe.parts)
    mixed = {
        mixer.title: map_to_gamut(mixer.mix(rgb, parts)[None], sensor, method).rgb[0]
        for mixer in mixers(cube)
    }
    if style == "json":
        rows = [{"theory": title, **_colour(cube, rgb)} for title, rgb in mixed.items()]
        print_json({"names": recipe.names, "theories": rows}, indent=None)
        return
    table = make_table()
    table.add_column("theory")
    for heading in ("hex", "linear RGB"):
        table.add_column(heading, no_wrap=True)
    for title, rgb in mixed.items():
        code = hex_code(cube, rgb)
        cell = Text(code).append("        " * has_colours(), style=f"on {code}")
        table.add_row(title, cell, format_rgb(rgb))
    show(table)


def _colour(cube: Cube, rgb: Array) -> dict[str, Any]:
    return {"rgb": as_lists(rgb), "hex": hex_code(cube, rgb), **coordinates(cube, rgb)}
