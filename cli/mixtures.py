"""Recipes of ``uplift mix`` and their mixtures, read and printed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from uplift.common.errors import OptionError, UpliftWarning

from .ingredients import SpectrumResolver, split_parts
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
from .output.diagnostics import warn
from .output.table import Table, swatch

if TYPE_CHECKING:
    from uplift.colorimetry.sensor import Sensor
    from uplift.common.arrays import Array
    from uplift.extras.paint.paints import Paints
    from uplift.lookup.cube import Cube

MIXTURE_MAPPING = "scale"
"""How mixtures are mapped into the gamut: it keeps the hue of bright ones."""
RAMP = 9
"""Swatches from the first ingredient to the last."""


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
        import numpy as np

        from uplift.extras.paint.optics import ramp

        return np.concatenate([[self.parts], ramp(self.parts, RAMP)])


def read_recipe(
    resolver: SpectrumResolver, words: Sequence[str], kind: str, paints: Paints | None
) -> Recipe:
    """Return the recipe of words, at the wavelengths of the resolver."""
    import numpy as np

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
    cube: Cube
    rgb: Array
    colours: list[dict[str, Any]]
    values: Array
    """Spectrum of the mixture at the wavelengths of the output."""


def display(
    recipe: Recipe, cube: Cube, sensor: Sensor, mixed: Array, method: str
) -> Mixture:
    """Return the colours of mixed spectra (n, N), whose first samples are those of the
    sensor, in the gamut.
    """
    import numpy as np

    from uplift.colorimetry.gamut import map_to_gamut

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
        for row, colour in zip(recipe.amounts, mapped.rgb, strict=True)
    ]
    return Mixture(recipe, cube, mapped.rgb, colours, mixed[0, count:])


def plot_ramp(mixture: Mixture, path: str, *, force: bool) -> None:
    from uplift.extras.colour.srgb import to_display_codes
    from uplift.extras.pages.plots import plot_strips

    recipe = mixture.recipe
    codes = to_display_codes(mixture.rgb, mixture.cube.data.sensor) / 255
    strips = {f"{recipe.kind}: {recipe.title}": codes[:1]}
    if len(recipe.names) > 1:
        strips[f"from {recipe.names[0]} to {recipe.names[-1]}"] = codes[1:]
    plot_strips(strips, path, force=force)


def print_mixture_json(mixture: Mixture, wavelengths: Array) -> None:
    answer = {
        "kind": mixture.recipe.kind,
        "names": mixture.recipe.names,
        **mixture.colours[0],
        "wavelengths": wavelengths.tolist(),
        "spectrum": as_lists(mixture.values),
        "ramp": mixture.colours[1:],
    }
    print_json(answer, indent=None)


def print_mixture(mixture: Mixture, wavelengths: Array, *, complete: bool) -> None:
    cube = mixture.cube
    colour, *steps = mixture.colours
    fields = {
        mixture.recipe.kind: mixture.recipe.title,
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
    formats = {
        "hex": lambda code: swatch(code, code),
        "rgb": ".6f",
    }
    table = Table(rows, headings, formats=formats)
    if style == "json":
        print_json({"names": recipe.names, "theories": rows}, indent=None)
    else:
        table.print_text()


def _colour(cube: Cube, rgb: Array) -> dict[str, Any]:
    return {"rgb": as_lists(rgb), "hex": hex_code(cube, rgb), **coordinates(cube, rgb)}
