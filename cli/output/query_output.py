"""Results of ``uplift query`` as table, JSON or CSV."""

from __future__ import annotations

import functools
import sys
import textwrap
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any

import click

from uplift.common.text import printable

from .console import (
    columns,
    csv_writer,
    emit,
    has_colours,
    make_table,
    print_json,
    say,
    show,
    terminal_json,
)
from .coordinates import coordinates, describe

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.lookup import Cube, QueryResult

BLOCKS = "▁▂▃▄▅▆▇█"
LARGEST = 1e30
NAME_WIDTH = 12
"""Characters of the names of fields."""
CELL_WIDTH = 20
"""Characters of a wavelength and its reflectance, with the space between columns."""
Writer = Callable[["Cube", Iterable[Sequence["QueryResult"]], bool], None]
"""Prints blocks of results, each before the next one is computed."""


def as_json(cube: Cube, blocks: Iterable[Sequence[QueryResult]], single: bool) -> None:
    """Print one object for a colour given on the command line, else an array."""
    if single:
        print_json(result_object(cube, _only(blocks)), indent=None)
        return
    for number, result in enumerate(chain.from_iterable(blocks)):
        separator = "[\n" if number == 0 else ",\n"
        emit(separator + terminal_json(result_object(cube, result)), nl=False)
    emit("\n]")


def result_object(cube: Cube, result: QueryResult) -> dict[str, Any]:
    """Return an answer as JSON values."""
    return {
        "rgb": result.rgb.tolist(),
        "requested_rgb": result.requested_rgb.tolist(),
        "wavelengths": result.wavelengths.tolist(),
        "reflectance": result.reflectance.tolist(),
        "xyz": result.xyz.tolist(),
        **coordinates(cube, result.rgb),
        "round_trip": {"rgb": result.round_trip.tolist(), "delta_e_2000": result.delta_e_2000},
        "cell": list(result.cell),
        "status": [status.label for status in result.statuses],
        "realisable": result.realisable,
        "entry": result.entry,
        "standard_error": result.standard_error,
        "error_bound": result.error_bound,
        "reference": cube.data.error_illuminant,
        "standard_errors": dict(result.standard_errors),
        "error_bounds": dict(result.error_bounds),
        "lights": {
            light: {"srgb": rgb.tolist(), "hex": code, "xyz": result.light_xyz[light].tolist()}
            for light, (rgb, code) in light_colours(cube, result).items()
        },
        "unlike_atlas": result.unlike_atlas,
    }


def as_csv(cube: Cube, blocks: Iterable[Sequence[QueryResult]], single: bool) -> None:
    """Print a row per colour: r, g, b, round-trip ΔE00, errors, entry, reflectance at each wavelength."""
    writer = csv_writer()
    for number, result in enumerate(chain.from_iterable(blocks)):
        if number == 0:
            wavelengths = [f"{wavelength:g}" for wavelength in result.wavelengths]
            names = ["", *(f"_{name}" for name in result.standard_errors)]
            errors = [f"{kind}{name}" for name in names for kind in ("standard_error", "error_bound")]
            codes = [f"hex_{name}" for name in result.light_xyz]
            writer.write(["r", "g", "b", "delta_e_2000", *errors, *codes, "entry", *wavelengths])
        expected = [value for pair in _errors(result).values() for value in pair]
        unknown = [""] * (len(errors) - len(expected))
        numbers = [*result.rgb.tolist(), result.delta_e_2000, *expected, *unknown]
        codes = [code for _, code in light_colours(cube, result).values()]
        writer.write([*numbers, *codes, result.entry or "", *result.reflectance.tolist()])


def as_table(cube: Cube, blocks: Iterable[Sequence[QueryResult]], single: bool) -> None:
    """Print a detailed view of a single colour, or a line per colour."""
    if single:
        _print_details(cube, _only(blocks))
    else:
        for number, block in enumerate(blocks):
            _print_lines(cube, block, heading=number == 0)


def _only(blocks: Iterable[Sequence[QueryResult]]) -> QueryResult:
    return next(iter(blocks))[0]


def _print_details(cube: Cube, result: QueryResult) -> None:
    data = cube.data
    fields = {
        **_mapped(cube, result),
        "linear RGB": f"{format_rgb(result.rgb)}  {hex_code(cube, result.rgb)}",
        **describe(cube, result.rgb),
        "cell": f"{result.cell} of {data.lattice.dim - 1}³, {', '.join(s.label for s in result.statuses)}",
        "round trip": f"{format_rgb(result.round_trip)}  ΔE00 {result.delta_e_2000:.2g} ({data.sensor.illuminant})",
        **({} if data.sensor.sensitivities is None else {"XYZ": format_rgb(result.xyz)}),
        **(
            {}
            if result.realisable
            else {"realisable": "no: the spectrum has less chroma, because no reflectance has this colour"}
        ),
        **_relit(cube, result),
        **_entry(cube, result),
        **_expected(cube, result),
        "spectrum": f"{sparkline(result.reflectance)}  {result.wavelengths[0]:g}–{result.wavelengths[-1]:g} nm",
    }
    print_fields(fields, {"linear RGB": patch(cube, result.rgb)})
    emit("")
    print_columns(result.wavelengths, result.reflectance)


def _mapped(cube: Cube, result: QueryResult) -> dict[str, str]:
    """Return the requested colour if it was outside [0, 1]."""
    from uplift.colorimetry.delta_e import delta_e_rgb

    if (result.requested_rgb == result.rgb).all():
        return {}
    requested = result.requested_rgb.clip(-LARGEST, LARGEST)  # ΔE00 of larger colours overflows
    distance = float(delta_e_rgb(cube.data.sensor, requested, result.rgb))
    return {"requested": f"{format_rgb(result.requested_rgb)}  outside [0, 1], mapped by ΔE00 {distance:.2g}"}


def light_colours(cube: Cube, result: QueryResult) -> dict[str, tuple[Array, str]]:
    """Return linear sRGB (3,) and '#rrggbb' of an answer by light; the white of each light is that of the screen."""
    if not result.light_xyz:
        return {}
    from uplift.colorimetry.srgb import hex_codes

    matrices = _to_srgb(tuple(result.light_xyz), cube.observer, cube.data.sensor.range)
    colours = {light: matrix @ result.light_xyz[light] for light, matrix in matrices.items()}
    return {light: (rgb, hex_codes(rgb[None])[0]) for light, rgb in colours.items()}


@functools.lru_cache(maxsize=1)
def _to_srgb(lights: tuple[str, ...], observer: str, limits: tuple[float, float, float]) -> dict[str, Array]:
    """Return the matrices (3, 3) from XYZ to linear sRGB by light."""
    from uplift.colorimetry.observer import display_sensors

    return {each.illuminant: each.xyz_to_rgb for each in display_sensors(lights, observer, *limits)}


def _relit(cube: Cube, result: QueryResult) -> dict[str, str]:
    colours = light_colours(cube, result).items()
    text = ", ".join(f"{code} {light} ({format_rgb(rgb)})" for light, (rgb, code) in colours)
    return {"sRGB under": text} if text else {}


def _expected(cube: Cube, result: QueryResult) -> dict[str, str]:
    """Return the standard errors and error bounds under all lights."""
    errors = _errors(result)
    if not errors:
        return {"std. error": "unknown: too few atlas entries"}
    names = (cube.data.error_illuminant, *result.standard_errors)
    standard, bound = (
        ", ".join(f"{value:.2g} ({name})" for name, value in zip(names, values, strict=True))
        for values in zip(*errors.values(), strict=True)
    )
    return {
        "std. error": f"ΔE00 {standard} to a measured material",
        "error bound": f"ΔE00 {bound} to 95 % of them",
    }


def _entry(cube: Cube, result: QueryResult) -> dict[str, str]:
    atlas = cube.data.atlas
    if result.entry in atlas.names[atlas.measured_count :]:
        return {"look": str(result.entry)}
    unknown = "none, and none is near: unlike the atlas" if result.unlike_atlas else "none"
    return {"atlas entry": result.entry or unknown}


def print_fields(fields: Mapping[str, str], patches: Mapping[str, str]) -> None:
    """Print names and values in two columns, and on a terminal the patches of colour that belong to a value."""
    width = columns()
    for name, text in fields.items():
        patch = f"  {patches[name]}" if sys.stdout.isatty() and patches.get(name) else ""
        lines = textwrap.wrap(printable(text), width - NAME_WIDTH, break_on_hyphens=False)
        indent = "\n" + " " * NAME_WIDTH
        emit(f"{name:<{NAME_WIDTH}}{indent.join(lines)}{patch}")


def patch(cube: Cube, rgb: Array, width: int = 8) -> str:
    """Return a patch of colour for a terminal, ``width`` characters wide."""
    return click.style(" " * width, bg=display_codes(cube, rgb))


def print_columns(wavelengths: Array, reflectance: Array) -> None:
    """Print wavelengths and reflectances in columns, ordered downwards."""
    cells = [f"{wavelength:>6g} nm {value:8.5f}" for wavelength, value in zip(wavelengths, reflectance, strict=True)]
    height = -(-len(cells) // max(1, (columns() + 2) // CELL_WIDTH))
    for line in range(height):
        say("  ".join(cells[line::height]))


def _print_lines(cube: Cube, results: Sequence[QueryResult], *, heading: bool) -> None:
    from rich.text import Text

    swatches = has_colours()
    names = list(results[0].standard_errors) if results else []
    errors = [f"± {light}" for light in (cube.data.error_illuminant, *names)] if names else []
    headings = ("",) * swatches + ("hex", "linear RGB", "ΔE00", "atlas entry", *(errors or ["spectrum"]))
    table = make_table(headings, box=None, show_header=heading)
    for result in results:
        red, green, blue = display_codes(cube, result.rgb)
        expected = [f"{error:.2f}" for error, _ in _errors(result).values()]
        table.add_row(
            *(Text("   ", style=f"on rgb({red},{green},{blue})"),) * swatches,
            hex_code(cube, result.rgb),
            " ".join(f"{value:.3f}" for value in result.rgb),
            f"{result.delta_e_2000:.2g}",
            result.entry or ("unlike the atlas" if errors and result.unlike_atlas else ""),
            *(expected if errors else [sparkline(result.reflectance, 16)]),
        )
    show(table)


def _errors(result: QueryResult) -> dict[str, tuple[float, float]]:
    """Standard error and error bound by light, that of the cube first and without a name; empty if unknown."""
    if result.standard_error is None or result.error_bound is None:
        return {}
    bounds = result.error_bounds
    by_light = {name: (error, bounds[name]) for name, error in result.standard_errors.items()}
    return {"": (result.standard_error, result.error_bound), **by_light}


def _codes(cube: Cube, rgb: Array) -> tuple[int, int, int]:
    red, green, blue = (round(float(code)) for code in cube.encode(rgb))
    return red, green, blue


def display_codes(cube: Cube, rgb: Array) -> tuple[int, int, int]:
    """Return 8-bit sRGB codes for a terminal."""
    from uplift.colorimetry.srgb import to_display_codes

    red, green, blue = (int(code) for code in to_display_codes(rgb, cube.data.sensor))
    return red, green, blue


def hex_code(cube: Cube, rgb: Array) -> str:
    """Return '#rrggbb' of linear RGB (3,), encoded by the transfer function of the cube's space."""
    return "#" + "".join(f"{code:02x}" for code in _codes(cube, rgb))


def format_rgb(rgb: Iterable[float]) -> str:
    """Return numbers with six decimals, separated by spaces."""
    return " ".join(f"{value:.6f}" for value in rgb)


def sparkline(reflectance: Array, width: int = 40) -> str:
    """Return the spectrum as block characters, from 0 to 1 in eighths."""
    count = len(reflectance)
    picks = [round(i * (count - 1) / max(min(width, count) - 1, 1)) for i in range(min(width, count))]
    return "".join(BLOCKS[round(float(reflectance[pick]) * (len(BLOCKS) - 1))] for pick in picks)


WRITERS: dict[str, Writer] = {"table": as_table, "json": as_json, "csv": as_csv}
