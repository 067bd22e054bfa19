"""Paints, fits and recipes of ``uplift paints`` as JSON, tables and pictures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from uplift.common.text import pluralise

from .mixtures import MIXTURE_MAPPING, coloured
from .output.console import paragraph, print_fields, print_json, say
from .output.table import Format, Table

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.extras.paint.paint_advice import PaintAdvice
    from uplift.extras.paint.paint_fit import PaintFit
    from uplift.extras.paint.paints import Paints
    from uplift.extras.paint.recipes import PaintRecipe, PaintTarget

WORST = 5
"""Worst samples that are listed."""
REACHED = 1.0
"""ΔE00 up to which a recipe is a match."""
PROVEN = 2
"""Paints of a recipe up to which no better parts exist."""


def hex_codes(paints: Paints, reflectance: Array) -> list[str]:
    """Return '#rrggbb' of reflectances (n, N) at the wavelengths of paints, as `uplift
    paints mix` does.
    """
    from uplift.colorimetry.gamut import map_to_gamut
    from uplift.extras.colour import srgb

    rgb = paints.sensor.rgb(reflectance)
    return srgb.hex_codes(map_to_gamut(rgb, paints.sensor, MIXTURE_MAPPING).rgb)


def paint_fields(paints: Paints) -> dict[str, Any]:
    """Return paints as JSON values."""
    import numpy as np

    colours = hex_codes(paints, paints.reflectance(np.eye(len(paints))))
    rows = []
    for colour, row in zip(colours, paints.rows(), strict=True):
        values = {
            key: value.tolist() if isinstance(value, np.ndarray) else value
            for key, value in row.items()
        }
        rows.append({"colour": colour, **values})
    return {
        "wavelengths": paints.wavelengths.tolist(),
        "surface": asdict(paints.surface),
        "paints": rows,
    }


def print_paints(paints: Paints) -> None:
    """Print a row for each paint."""
    import numpy as np

    from uplift.extras.paint.paints import TINT_PARTS, strengths

    columns = {
        "paint": paints.names,
        "colour": hex_codes(paints, paints.reflectance(np.eye(len(paints)))),
        "tint": hex_codes(paints, paints.tints()),
        "strength": strengths(paints, paints.lightest).tolist(),
    }
    headings = {name: name for name in columns}
    if paints.errors is not None:
        columns["S"] = np.median(paints.errors.scattering, axis=1).tolist()
        columns["K"] = np.median(paints.errors.absorption, axis=1).tolist()
        headings |= {"S": "± S", "K": "± K"}
    cells = zip(*columns.values(), strict=True)
    rows = [dict(zip(columns, row, strict=True)) for row in cells]
    formats: dict[str, Format] = {
        "colour": coloured,
        "tint": coloured,
        "strength": ".2g",
    }
    Table(rows, headings, digits=".0%", formats=formats).print_text()
    surface = paints.surface
    paragraph(
        f"Tints are 1 : {TINT_PARTS} with {paints.names[paints.lightest]}. The surface "
        f"reflects {surface.outside:.1%} of light from air and {surface.inside:.0%} of "
        "light from within."
    )


def print_fit_json(fitted: PaintFit, advice: PaintAdvice, output: str) -> None:
    """Print a fit as JSON."""
    samples = zip(fitted.samples.names, fitted.delta_e.tolist(), strict=True)
    answer = {
        "output": output,
        **paint_fields(fitted.paints),
        "notes": fitted.samples.notes,
        "noise": asdict(fitted.noise),
        "samples": [{"name": name, "delta_e": error} for name, error in samples],
        "mixtures_error": advice.error,
        "next": [
            {"sample": sample.name, "mixtures_error": sample.error}
            for sample in advice.samples
        ],
    }
    print_json(answer)


def print_fit(fitted: PaintFit, advice: PaintAdvice) -> None:
    """Print the paints, the worst samples, and which samples to measure next."""
    import numpy as np

    print_paints(fitted.paints)
    errors = fitted.delta_e
    say()
    paragraph(
        f"{pluralise(len(errors), 'sample')} predicted to a median ΔE00 of "
        f"{np.median(errors):.2f}, at most {errors.max():.2f}."
    )
    worst = [
        f"{fitted.samples.names[row]} ({errors[row]:.1f})"
        for row in fitted.doubtful[:WORST]
    ]
    if worst:
        paragraph(f"Check the parts and measurements of: {', '.join(worst)}.")
    if unmixed := fitted.samples.unmixed:
        paragraph(
            "Known by one opaque sample, which does not show the strength; a rule "
            f"stands in for it: {', '.join(unmixed)}."
        )
    if advice.samples:
        print_fields({"expected error": f"ΔE00 {advice.error:.2f} of mixtures of two"})
        headings = {"name": "measure next", "error": "then expected ΔE00"}
        Table(list(map(vars, advice.samples)), headings, digits=".2f").print_text()


def recipe_rows(
    target: PaintTarget, paints: Paints, recipes: Sequence[PaintRecipe]
) -> list[dict[str, Any]]:
    """Return recipes as JSON values."""
    from uplift.extras.paint.recipes import elsewhere

    lights = [light.name for light in target.lights]
    rows = []
    for recipe in recipes:
        pairs = zip(recipe.paints, recipe.parts, strict=True)
        rows.append(
            {
                "paints": [{"name": name, "parts": parts} for name, parts in pairs],
                "colour": hex_codes(paints, recipe.reflectance[None])[0],
                "delta_e": dict(zip(lights, recipe.delta_e, strict=True)),
                "elsewhere": elsewhere(target, paints, recipe),
                "cost": None if recipe.cost != recipe.cost else recipe.cost,
            }
        )
    return rows


def print_recipes(
    rows: Sequence[dict[str, Any]], recipes: Sequence[PaintRecipe], code: str, most: int
) -> None:
    """Print a row for each recipe, of at most so many paints, for a colour."""
    errors = [row["delta_e"] | row["elsewhere"] for row in rows]
    headings = {"recipe": "recipe", "colour": code}
    headings |= {name: f"ΔE00 {name}" for name in rows[0]["delta_e"]}
    headings |= {name: name for name in rows[0]["elsewhere"]}
    if any(row["cost"] is not None for row in rows):
        headings["cost"] = "cost"
    lines = [
        {"recipe": str(recipe), **row, **by_light}
        for recipe, row, by_light in zip(recipes, rows, errors, strict=True)
    ]
    formats: dict[str, Format] = {"colour": coloured, "cost": ".3g"}
    Table(lines, headings, digits=".2f", formats=formats).print_text()
    if recipes[0].error > REACHED:
        paragraph(
            f"No mixture of {pluralise(most, 'paint')} reaches the colour: the nearest "
            f"differs by ΔE00 {recipes[0].error:.1f}."
        )
    if most > PROVEN:
        paragraph(
            f"Recipes of more than {PROVEN} paints are the best of several solutions, "
            "not proven to be the best of all."
        )


def plot_recipes(
    target: PaintTarget, recipes: Sequence[PaintRecipe], path: str, *, force: bool
) -> None:
    """Draw the target next to each recipe, under the first light."""
    import numpy as np

    from uplift.colorimetry import observer
    from uplift.colorimetry.tables import bradford
    from uplift.extras.colour.srgb import encode
    from uplift.extras.pages.plots import plot_strips

    light = target.lights[0]
    display = observer.sensor()
    # The white of the light is shown as that of displays.
    to_rgb = display.xyz_to_rgb @ bradford(light.white, display.light.white)
    strips = {}
    for recipe in recipes:
        spectra = np.stack([target.reflectance, recipe.reflectance])
        title = f"{recipe}: ΔE00 {recipe.error:.2f}"
        strips[title] = encode(spectra @ light.xyz.T @ to_rgb.T)
    plot_strips(strips, path, force=force)
