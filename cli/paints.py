"""Targets, fits and recipes of ``uplift paints``, read and printed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from uplift.common.text import pluralise

from .mixtures import MIXTURE_MAPPING
from .output.console import make_table, paragraph, print_fields, say, show, swatch

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.common.arrays import Array
    from uplift.extras.paint.paint_advice import PaintAdvice
    from uplift.extras.paint.paint_fit import PaintFit
    from uplift.extras.paint.paints import Paints
    from uplift.extras.paint.recipes import PaintRecipe, PaintTarget

WORST = 5
"""Worst samples that are listed."""
ODD = 3.0
"""ΔE00, in that of the median sample, from which a sample may be wrong."""
TINT_PARTS = 4
"""Parts of white to one of paint in a tint."""
REACHED = 1.0
"""ΔE00 up to which a recipe is a match."""
PROVEN = 2
"""Paints of a recipe up to which no better parts exist."""


def read_target(
    paints: Paints,
    colour: str | None,
    spectrum_path: str | None,
    cube_path: str | None,
    files: Sequence[str],
    lights: Sequence[Illuminant],
    thickness: float | None,
    ground: str | None,
) -> PaintTarget:
    """Return what a recipe should match, at the wavelengths of the paints."""
    from uplift.atlas.atlas import Atlas
    from uplift.atlas.resampling import on_grid
    from uplift.atlas.sources import read_atlas
    from uplift.extras.paint.recipes import PaintTarget
    from uplift.lookup.cube import load

    from .ingredients import SpectrumResolver

    nm = paints.wavelengths
    atlas = read_atlas(*files) if files else Atlas()
    resolver = SpectrumResolver(load(cube_path), atlas, nm)
    if spectrum_path is not None:
        entry = read_atlas(spectrum_path).entries[0]
        reflectance = on_grid(Atlas((entry,)), nm)[0]
    else:
        reflectance = resolver.spectrum(str(colour))
    lit = tuple(paints.light(name) for name in lights or ("D65",))
    backing: Array | float = 1.0 if ground is None else resolver.spectrum(ground)
    return PaintTarget(reflectance, lit, thickness, backing)


def _hex(paints: Paints, reflectance: Array) -> list[str]:
    """Return '#rrggbb' of reflectances (n, N) at the wavelengths of paints, as `uplift
    mix` does.
    """
    from uplift.colorimetry.gamut import map_to_gamut
    from uplift.extras.colour.srgb import hex_codes

    rgb = paints.sensor.rgb(reflectance)
    return hex_codes(map_to_gamut(rgb, paints.sensor, MIXTURE_MAPPING).rgb)


def fit_fields(fitted: PaintFit, advice: PaintAdvice) -> dict[str, Any]:
    """Return a fit as JSON values."""
    samples = zip(fitted.samples.names, fitted.delta_e.tolist(), strict=True)
    return {
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


def paint_fields(paints: Paints) -> dict[str, Any]:
    """Return paints as JSON values."""
    import numpy as np

    colours = _hex(paints, paints.reflectance(np.eye(len(paints))))
    rows = []
    for row, name in enumerate(paints.names):
        fields: dict[str, Any] = {"name": name, "colour": colours[row]}
        fields["absorption"] = paints.pigments.absorption[row].tolist()
        fields["scattering"] = paints.pigments.scattering[row].tolist()
        if paints.errors is not None:
            fields["absorption_errors"] = paints.errors.absorption[row].tolist()
            fields["scattering_errors"] = paints.errors.scattering[row].tolist()
        if paints.prices and np.isfinite(paints.prices[row]):
            fields["price"] = paints.prices[row]
        rows.append(fields)
    return {
        "wavelengths": paints.wavelengths.tolist(),
        "surface": {
            "outside": paints.surface.outside,
            "inside": paints.surface.inside,
        },
        "paints": rows,
    }


def print_paints(paints: Paints) -> None:
    """Print a row for each paint."""
    import numpy as np

    from uplift.extras.paint.paints import strengths

    own = paints.reflectance(np.eye(len(paints)))
    masstones = _hex(paints, own)
    white = int(own.min(axis=1).argmax())
    tint_parts = np.eye(len(paints)) + TINT_PARTS * np.eye(len(paints))[white]
    tints = _hex(paints, paints.reflectance(tint_parts))
    table = make_table(("paint", "", "tint", ""), ("strength", "± S", "± K"))
    for row, name in enumerate(paints.names):
        errors = ("", "")
        if paints.errors is not None:
            scattering = np.median(paints.errors.scattering[row])
            absorption = np.median(paints.errors.absorption[row])
            errors = (f"{scattering:.0%}", f"{absorption:.0%}")
        table.add_row(
            name,
            _cell(masstones[row]),
            tints[row],
            _cell(tints[row], ""),
            f"{strengths(paints, white)[row]:.2g}",
            *errors,
        )
    show(table)
    surface = paints.surface
    paragraph(
        f"Tints are 1 : {TINT_PARTS} with {paints.names[white]}. The surface reflects "
        f"{surface.outside:.1%} of light from air and {surface.inside:.0%} of light "
        "from within."
    )


def _cell(code: str, text: str | None = None) -> Any:
    from rich.text import Text

    cell = Text(code if text is None else text)
    return cell.append(swatch(bytes.fromhex(code[1:])))


def print_fit(fitted: PaintFit, advice: PaintAdvice) -> None:
    """Print the paints, the worst samples, and which samples to measure next."""
    import numpy as np

    print_paints(fitted.paints)
    errors = fitted.delta_e
    median = float(np.median(errors))
    say()
    paragraph(
        f"{pluralise(len(errors), 'sample')} predicted to a median ΔE00 of "
        f"{median:.2f}, at most {errors.max():.2f}."
    )
    odd = [row for row in np.argsort(-errors) if errors[row] > max(ODD * median, 1.0)]
    if odd:
        worst = [f"{fitted.samples.names[row]} ({errors[row]:.1f})" for row in odd]
        paragraph(f"Check the parts and measurements of: {', '.join(worst[:WORST])}.")
    alone = [
        name
        for row, name in enumerate(fitted.paints.names)
        if np.count_nonzero(fitted.samples.shares[:, row]) == 1
    ]
    opaque = [name for name in alone if _is_masstone(fitted, name)]
    if opaque:
        paragraph(
            "Known by one opaque sample, which does not show the strength; a rule "
            f"stands in for it: {', '.join(opaque)}."
        )
    if advice.samples:
        print_fields({"expected error": f"ΔE00 {advice.error:.2f} of mixtures of two"})
        table = make_table(("measure next", "then expected ΔE00"))
        for sample in advice.samples:
            table.add_row(sample.name, f"{sample.error:.2f}")
        show(table)


def _is_masstone(fitted: PaintFit, name: str) -> bool:
    samples = fitted.samples
    shares = samples.shares[:, samples.paints.index(name)]
    row = int(shares.argmax())
    return bool(shares[row] == 1 and samples.is_opaque[row])


def match_fields(
    target: PaintTarget, paints: Paints, recipes: Sequence[PaintRecipe]
) -> dict[str, Any]:
    """Return recipes as JSON values."""
    lights = [light.name for light in target.lights]
    rows = []
    for recipe in recipes:
        pairs = zip(recipe.paints, recipe.parts, strict=True)
        rows.append(
            {
                "paints": [{"name": name, "parts": parts} for name, parts in pairs],
                "colour": _hex(paints, recipe.reflectance[None])[0],
                "delta_e": dict(zip(lights, recipe.delta_e, strict=True)),
                "elsewhere": elsewhere(target, paints, recipe),
                "cost": None if recipe.cost != recipe.cost else recipe.cost,
            }
        )
    return {
        "colour": _hex(paints, target.reflectance[None])[0],
        "lights": lights,
        "recipes": rows,
    }


def elsewhere(
    target: PaintTarget, paints: Paints, recipe: PaintRecipe
) -> dict[str, float]:
    """Return ΔE00 between a recipe and its target under further lights, the index of
    metamerism.
    """
    from uplift.colorimetry.delta_e import delta_e_spectra
    from uplift.extras.colour.light_sets import RELIGHT_LIGHTS

    known = {light.name for light in target.lights}
    errors = {}
    for name in RELIGHT_LIGHTS:
        light = paints.light(name)
        if light.name not in known:
            error = delta_e_spectra(light, recipe.reflectance, target.reflectance)
            errors[light.name] = float(error)
    return errors


def print_recipes(
    target: PaintTarget, paints: Paints, recipes: Sequence[PaintRecipe], count: int
) -> None:
    """Print a row for each recipe."""
    code = _hex(paints, target.reflectance[None])[0]
    has_cost = any(recipe.cost == recipe.cost for recipe in recipes)
    lights = [light.name for light in target.lights]
    others = list(elsewhere(target, paints, recipes[0]))
    table = make_table(
        ("recipe", code),
        (*(f"ΔE00 {name}" for name in lights), *others, *(["cost"] * has_cost)),
    )
    for recipe in recipes:
        pairs = zip(recipe.parts, recipe.paints, strict=True)
        text = " + ".join(f"{parts} {name}" for parts, name in pairs)
        errors = [*recipe.delta_e, *elsewhere(target, paints, recipe).values()]
        cells = [f"{error:.2f}" for error in errors]
        cells += [f"{recipe.cost:.3g}"] * has_cost
        mixed = _hex(paints, recipe.reflectance[None])[0]
        table.add_row(text, _cell(mixed), *cells)
    show(table)
    if recipes[0].error > REACHED:
        paragraph(
            f"No mixture of {pluralise(min(count, len(paints)), 'paint')} reaches the "
            f"colour: the nearest differs by ΔE00 {recipes[0].error:.1f}."
        )
    if min(count, len(paints)) > PROVEN:
        paragraph(
            f"Recipes of more than {PROVEN} paints are the best of several solutions, "
            "not proven to be the best of all."
        )


def plot_recipes(
    target: PaintTarget, recipes: Sequence[PaintRecipe], path: str, *, force: bool
) -> None:
    """Draw the target next to each recipe."""
    import numpy as np

    from uplift.extras.colour.srgb import encode
    from uplift.extras.pages.plots import plot_strips

    light = target.lights[0]
    strips = {}
    for recipe in recipes:
        pairs = zip(recipe.parts, recipe.paints, strict=True)
        title = " + ".join(f"{parts} {name}" for parts, name in pairs)
        spectra = np.stack([target.reflectance, recipe.reflectance])
        colours = _display(spectra @ light.xyz.T, light.white)
        strips[f"{title}: ΔE00 {recipe.error:.2f}"] = encode(colours)
    plot_strips(strips, path, force=force)


def _display(xyz: Array, white: Array) -> Array:
    """Return linear sRGB (n, 3) of XYZ, adapted to the white of displays."""
    from uplift.colorimetry import observer
    from uplift.colorimetry.tables import bradford

    display = observer.sensor()
    adapt = bradford(white, display.light.white)
    return xyz @ (display.xyz_to_rgb @ adapt).T
