"""Colours and spectra as text: patches, sparklines, columns, coordinates."""

from __future__ import annotations

import colorsys
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import click

from .console import has_colours, print_fields, say, window_width

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.lookup.cube import Cube

BLOCKS = "▁▂▃▄▅▆▇█"
CELL_WIDTH = 20
"""Characters of a wavelength and its reflectance, with the space between columns."""
MAX_CELLS = 24
"""Wavelengths that are printed where the user names none; JSON and CSV have all."""


def print_spectrum(
    fields: dict[str, str],
    wavelengths: Array,
    values: Array,
    *,
    complete: bool,
    patches: dict[str, str] | None = None,
    highest: float = 1.0,
) -> None:
    """Print fields, a sparkline up to the ``highest`` value, and wavelengths and values
    in columns, downwards.

    At most `MAX_CELLS` of them are printed, unless ``complete``.
    """
    ends = f"{wavelengths[0]:g}–{wavelengths[-1]:g} nm"
    print_fields(
        fields | {"spectrum": f"{sparkline(values / highest)}  {ends}"}, patches
    )
    say()
    step = 1 if complete else -(-len(wavelengths) // MAX_CELLS)
    pairs = zip(wavelengths[::step], values[::step], strict=True)
    cells = [f"{wavelength:>6g} nm {value:8.5f}" for wavelength, value in pairs]
    height = -(-len(cells) // max(1, (window_width() + 2) // CELL_WIDTH))
    for line in range(height):
        say("  ".join(cells[line::height]))


def patch(cube: Cube, rgb: Array, width: int = 8) -> str:
    """Return a patch of colour, ``width`` characters wide; empty where standard output
    shows no colours.
    """
    if not has_colours():
        return ""
    from uplift.extras.colour.srgb import to_display_codes

    codes = to_display_codes(rgb, cube.data.sensor)
    return click.style(" " * width, bg=codes.astype(int).tolist())


def hex_code(cube: Cube, rgb: Array) -> str:
    """Return '#rrggbb' of linear RGB (3,), encoded as in the cube's space."""
    return hex_codes(cube, rgb[None])[0]


def hex_codes(cube: Cube, rgb: Array) -> list[str]:
    """Return the `hex_code` of linear RGB (n, 3)."""
    codes = cube.encode(rgb).round().astype("u1").tobytes()
    return [f"#{code}" for code in codes.hex(" ", 3).split()]


def as_lists(values: Array) -> list[Any]:
    """Return colours or reflectances as lists. Rounding errors of 0 are 0."""
    return list(without_rounding(values).tolist())


def without_rounding(values: Array) -> Array:
    """Return colours or reflectances whose rounding errors of 0 are 0."""
    from uplift.colorimetry.sensor import ROUNDING

    return values * (abs(values) > ROUNDING) + 0.0  # -0.0 + 0.0 is 0.0


def format_rgb(rgb: Iterable[float]) -> str:
    """Return numbers with six decimals, separated by spaces."""
    # -0.0 + 0.0 is 0.0
    return " ".join(f"{round(value, 6) + 0.0:.6f}" for value in rgb)


def sparkline(values: Array, width: int = 40) -> str:
    """Return a spectrum as block characters, from 0 to 1 in eighths."""
    return sparklines(values[None], width)[0]


def sparklines(values: Array, width: int) -> list[str]:
    """Return the `sparkline` of spectra (n, N)."""
    import numpy as np

    width = min(width, values.shape[1])
    last = values.shape[1] - 1
    cells = np.rint(np.arange(width) * last / max(width - 1, 1)).astype(int)
    levels = np.rint(values[:, cells] * (len(BLOCKS) - 1)).astype(int)
    return ["".join(row) for row in np.array(list(BLOCKS))[levels].tolist()]


def coordinates(cube: Cube, rgb: Array) -> dict[str, Any]:
    """Return the `coordinate_columns` of linear RGB (3,)."""
    columns = coordinate_columns(cube, rgb[None])
    return {name: column[0] for name, column in columns.items()}


def coordinate_columns(cube: Cube, rgb: Array) -> dict[str, list[Any]]:
    """Return HSV, HSL, YIQ, dominant wavelength and purity of linear RGB (n, 3) for
    JSON (Fishkin 1983, 3.11–3.13).

    HSV, HSL and YIQ are those of the encoded components, as displays and broadcasts use
    them, clipped to [0, 1]. Empty for a camera, whose values no display shows.
    """
    from uplift.extras.colour.dominant import dominant_wavelengths

    sensor = cube.data.sensor
    if sensor.sensitivities is not None:
        return {}
    encoded = (cube.encode(rgb) / 255).T.tolist()
    hls = map(colorsys.rgb_to_hls, *encoded)
    # one by one, as the rounding of a product depends on its size
    xyz = sensor.xyz(rgb[:, None])[:, 0]
    wavelengths, complementary, purity = dominant_wavelengths(xyz, sensor)
    return {
        "hsv": list(map(list, map(colorsys.rgb_to_hsv, *encoded))),
        "hsl": [[hue, saturation, lightness] for hue, lightness, saturation in hls],
        "yiq": list(map(list, map(colorsys.rgb_to_yiq, *encoded))),
        "dominant_wavelength": known(wavelengths),
        "complementary": complementary.tolist(),
        "purity": purity.tolist(),
    }


def known(values: Array) -> list[float | None]:
    """Return numbers (n,), None for NaN."""
    return [None if value != value else value for value in values.tolist()]


def describe_coordinates(values: dict[str, Any]) -> dict[str, str]:
    """Return `coordinates` for a table, by the name of the row; empty for a camera."""
    if "hsv" not in values:
        return {}
    kind = "complement of " if values["complementary"] else ""
    wavelength = values["dominant_wavelength"]
    hue = (
        "grey"
        if wavelength is None
        else f"{kind}{wavelength:.0f} nm, purity {values['purity']:.2f}"
    )
    codes = []
    for name in ("hsv", "hsl", "yiq"):
        first, second, third = (round(value, 2) + 0.0 for value in values[name])
        if name != "yiq":
            first %= 1  # a hue of 1 is 0
        codes.append(f"{name.upper()} {first:.2f} {second:.2f} {third:.2f}")
    return {"hue": hue, "encoded": ", ".join(codes)}
