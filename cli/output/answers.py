"""Colours and spectra as text and as lists."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import click

from .console import has_colours, print_fields, say, window_width

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.lookup.cube import Cube

CELL_WIDTH = 20
"""Characters of a wavelength and its reflectance, with the space between columns."""
MAX_CELLS = 24
"""Wavelengths that are printed where the user names none; JSON and CSV have all."""


def print_spectrum(
    fields: Mapping[str, str],
    wavelengths: Array,
    values: Array,
    *,
    complete: bool,
    patches: Mapping[str, str] | None = None,
    highest: float = 1.0,
) -> None:
    """Print fields, a sparkline up to the ``highest`` value, and wavelengths and values
    in columns, downwards.

    At most `MAX_CELLS` of them are printed, unless ``complete``.
    """
    ends = f"{wavelengths[0]:g}–{wavelengths[-1]:g} nm"
    print_fields(
        {**fields, "spectrum": f"{sparkline(values / highest)}  {ends}"}, patches
    )
    say()
    step = 1 if complete else -(-len(wavelengths) // MAX_CELLS)
    pairs = zip(wavelengths[::step], values[::step], strict=True)
    cells = [f"{wavelength:>6g} nm {value:8.5f}" for wavelength, value in pairs]
    height = -(-len(cells) // max(1, (window_width() + 2) // CELL_WIDTH))
    for line in range(height):
        say("  ".join(cells[line::height]))


def sparkline(values: Array, width: int = 40) -> str:
    """Draw a spectrum (N,) from 0 to 1."""
    from uplift.extras.colour.sparkline import sparklines

    return sparklines(values[None], width)[0]


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


def coordinates(cube: Cube, rgb: Array) -> dict[str, Any]:
    """Return the coordinates of linear RGB (3,)."""
    from uplift.extras.colour.coordinates import coordinates

    columns = coordinates(cube, rgb[None])
    return {name: column[0] for name, column in columns.items()}


def describe_coordinates(values: Mapping[str, Any]) -> dict[str, str]:
    from uplift.extras.colour.coordinates import describe

    return describe(values)
