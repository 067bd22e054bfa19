"""Bounds of a colour as JSON and as rows of a table."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from .answers import format_rgb, hex_code, patch
from .console import make_table, print_fields, say

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.extras.looks.metamer_bounds import Bounds
    from uplift.lookup.cube import Cube

    from .tables import SafeTable


def bounds_fields(bounds: Bounds, row: int) -> dict[str, Any]:
    """Return the bounds of a colour as JSON values."""
    from uplift.colorimetry.delta_e import lab
    from uplift.extras.looks.lab_errors import LIKELY

    largest = bounds.largest
    likely = bounds.likely(row)
    covariance = bounds.covariance
    return {
        "lab": bounds.lab[row].tolist(),
        "largest_delta_e_2000": float(largest.delta_e_2000[row]),
        "largest_lab": lab(largest.xyz[row], bounds.light.white).tolist(),
        "outer_delta_e_2000": float(largest.outer[row]),
        "lab_range": bounds.box[row].tolist(),
        "share": float(bounds.share[row]),
        "outline": bounds.outline(row).tolist(),
        "covariance": None if covariance is None else covariance[row].tolist(),
        "likely": None if likely is None else likely.tolist(),
        "likely_share": LIKELY,
    }


def bounds_table(headings: Sequence[str], *, show_header: bool = True) -> SafeTable:
    from uplift.extras.looks.lab_errors import LIKELY

    return make_table(
        headings,
        ("L* a* b*", f"ΔE {LIKELY:.0%}", "ΔE max", "a* range", "b* range", "share"),
        show_header=show_header,
    )


def bounds_cells(bounds: Bounds, row: int, error: float | None) -> tuple[str, ...]:
    """Return the cells of a colour, with the ΔE00 of likely materials."""
    (_, least_a, least_b), (_, most_a, most_b) = bounds.box[row].tolist()
    return (
        " ".join(map("{:.1f}".format, bounds.lab[row])),
        "–" if error is None else f"{error:.2f}",
        f"{bounds.largest.delta_e_2000[row]:.2f}",
        f"{round(least_a)}..{round(most_a)}",
        f"{round(least_b)}..{round(most_b)}",
        f"{100 * bounds.share[row]:.2g}%",
    )


def print_colours(cube: Cube, rgb: Array, names: Sequence[str], others: Array) -> None:
    """Print the linear RGB under the light of the cube, and under further lights."""
    fields = {"linear RGB": f"{format_rgb(rgb)}  {hex_code(cube, rgb)}"}
    for name, values in zip(names, others, strict=True):
        fields[f"under {name}"] = f"{format_rgb(values)}  {hex_code(cube, values)}"
    print_fields(fields, {"linear RGB": patch(cube, rgb)})
    say()
