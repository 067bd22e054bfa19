"""The palette as a table: every material under every light, and under the mix."""

from __future__ import annotations

from uplift.colorimetry.srgb import hex_codes
from uplift.common.arrays import Array
from uplift.design.palette.relight_viewer.relighting import Relighting
from uplift.report.page_parts import note, swatch, table
from uplift.viz.markup import Markup, element

TOLD = (
    "The left half of a patch is the colour by whole spectra, the right half that of the factor model, which the "
    "picture is drawn with. A light's name lights the picture with it alone; a material's name finds it in the picture."
)


def palette_table(shown: Relighting) -> Markup:
    """A row a material, a column a light; the script keeps the last column."""
    headings = [
        "material",
        *(_light(row, name) for row, name in enumerate(shown.lights.names)),
        "mixed light",
    ]
    whole, factor = shown.materials.colours, _factor_colours(shown)
    lines = [
        [_material(row, name), *_patches(whole[row], factor[row]), _mixed(f"mixed-{row}")]
        for row, name in enumerate(shown.materials.names)
    ]
    white = [
        element("td", "white", class_="name"),
        *_patches(shown.lights.white, None),
        _mixed("mixed-white"),
    ]
    return element(
        "section", element("h2", "Palette"), note(TOLD), table(headings, [white, *lines], "patches")
    )


def _factor_colours(shown: Relighting) -> Array:
    """(n, L, 3) linear sRGB of the factor model."""
    lit = shown.materials.coefficients[:, None] * shown.lights.coefficients
    return lit @ shown.to_rgb.T


def _light(row: int, name: str) -> Markup:
    return element("th", element("button", name, type="button", data_light=row), class_="light")


def _material(row: int, name: str) -> Markup:
    button = element("button", name, type="button", data_material=row, aria_pressed="false")
    return element("td", button, class_="name")


def _patches(whole: Array, factor: Array | None) -> list[Markup]:
    """A cell for each light; the perfect reflector's is by whole spectra alone."""
    halves = [hex_codes(whole)] if factor is None else [hex_codes(whole), hex_codes(factor)]
    return [element("td", swatch(*codes)) for codes in zip(*halves, strict=True)]


def _mixed(name: str) -> Markup:
    return element("td", element("span", id=name, class_="swatch"), element("code", id=f"{name}-told"))
