"""Answers on paper: table, JSON, CSV. Only the table is meant for eyes."""

from __future__ import annotations

import csv
import sys
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import click

from .console import console, json_text

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.lookup import Cube, QueryResult

BLOCKS = "▁▂▃▄▅▆▇█"
Writer = Callable[["Cube", Iterable["QueryResult"], bool], None]


def as_json(cube: Cube, answers: Iterable[QueryResult], single: bool) -> None:
    """One object for one colour asked on the command line, an array otherwise."""
    if single:
        click.echo(json_text(_object(cube, next(iter(answers))), indent=None))
        return
    for number, answer in enumerate(answers):
        click.echo(
            ("[\n" if number == 0 else ",\n") + json_text(_object(cube, answer), indent=None), nl=False
        )
    click.echo("\n]")


def _object(cube: Cube, answer: QueryResult) -> dict[str, Any]:
    return {
        "rgb": answer.rgb.tolist(),
        "asked": answer.asked.tolist(),
        "wavelengths": answer.wavelengths.tolist(),
        "reflectance": answer.reflectance.tolist(),
        "round_trip": {"rgb": answer.round_trip.tolist(), "delta_e_2000": answer.delta_e_2000},
        "cell": list(answer.cell),
        "status": [status.label for status in answer.statuses],
        "realisable": answer.realisable,
        "entry": answer.entry,
        "standard_error": answer.standard_error,
        "reference": cube.data.error_illuminant,
    }


def as_csv(cube: Cube, answers: Iterable[QueryResult], single: bool) -> None:
    """A row a colour: r, g, b, ΔE00 of the round trip, standard error, entry, reflectance at each wavelength."""
    writer = csv.writer(sys.stdout, lineterminator="\n")
    for number, answer in enumerate(answers):
        if number == 0:
            wavelengths = [f"{wavelength:g}" for wavelength in answer.wavelengths]
            writer.writerow(["r", "g", "b", "delta_e_2000", "standard_error", "entry", *wavelengths])
        expected = "" if answer.standard_error is None else answer.standard_error
        numbers = [*answer.rgb.tolist(), answer.delta_e_2000, expected]
        writer.writerow([*numbers, answer.entry or "", *answer.reflectance.tolist()])


def as_table(cube: Cube, answers: Iterable[QueryResult], single: bool) -> None:
    """A sheet for one colour, a line each for several."""
    if single:
        _sheet(cube, next(iter(answers)))
    else:
        _lines(cube, answers)


def _sheet(cube: Cube, answer: QueryResult) -> None:
    data = cube.data
    patch = click.style("        ", bg=shown_codes(cube, answer.rgb))
    facts = {
        **_moved(cube, answer),
        "linear RGB": f"{triple(answer.rgb)}  {hex_code(cube, answer.rgb)}  {patch}",
        "cell": f"{answer.cell} of {data.lattice.dim - 1}³, {', '.join(s.label for s in answer.statuses)}",
        "round trip": f"{triple(answer.round_trip)}  ΔE00 {answer.delta_e_2000:.2g} ({data.sensor.illuminant})",
        **(
            {}
            if answer.realisable
            else {"realisable": "no: no reflectance has this colour, the answer has less chroma"}
        ),
        "atlas entry": answer.entry or "none here",
        "measured": _expected(cube, answer),
        "spectrum": f"{sparkline(answer.reflectance)}  {answer.wavelengths[0]:g}–{answer.wavelengths[-1]:g} nm",
    }
    for name, text in facts.items():
        click.echo(f"{name:<12}{text}")
    click.echo()
    columns(answer.wavelengths, answer.reflectance)


def _moved(cube: Cube, answer: QueryResult) -> dict[str, str]:
    """What was asked, where it lay outside [0, 1]."""
    from uplift.colorimetry.delta_e import delta_e_rgb

    if (answer.asked == answer.rgb).all():
        return {}
    apart = float(delta_e_rgb(cube.data.sensor, answer.asked, answer.rgb))
    return {"asked": f"{triple(answer.asked)}  outside [0, 1], moved by ΔE00 {apart:.2g}"}


def _expected(cube: Cube, answer: QueryResult) -> str:
    if answer.standard_error is None:
        return "no telling: too few atlas entries"
    return f"may differ by ΔE00 {answer.standard_error:.2g} ({cube.data.error_illuminant}; standard error)"


def columns(wavelengths: Array, reflectance: Array) -> None:
    """Wavelengths and reflectances, four pairs a line, to be read downwards."""
    cells = [
        f"{wavelength:>6g} nm {value:8.5f}"
        for wavelength, value in zip(wavelengths, reflectance, strict=True)
    ]
    height = -(-len(cells) // 4)
    for line in range(height):
        click.echo("  ".join(cells[line::height]))


def _lines(cube: Cube, answers: Iterable[QueryResult]) -> None:
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False)
    for heading in ("", "hex", "linear RGB", "ΔE00", "atlas entry", "spectrum"):
        table.add_column(heading, no_wrap=True)
    for answer in answers:
        red, green, blue = shown_codes(cube, answer.rgb)
        table.add_row(
            Text("   ", style=f"on rgb({red},{green},{blue})"),
            hex_code(cube, answer.rgb),
            " ".join(f"{value:.3f}" for value in answer.rgb),
            f"{answer.delta_e_2000:.2g}",
            Text(answer.entry or ""),
            sparkline(answer.reflectance, 20),
        )
    console().print(table)


def _codes(cube: Cube, rgb: Array) -> tuple[int, int, int]:
    red, green, blue = (round(float(code)) for code in cube.encode(rgb))
    return red, green, blue


def shown_codes(cube: Cube, rgb: Array) -> tuple[int, int, int]:
    """What the terminal's screen shows it as."""
    from uplift.colorimetry.srgb import to_display_codes

    red, green, blue = (int(code) for code in to_display_codes(rgb, cube.data.sensor))
    return red, green, blue


def hex_code(cube: Cube, rgb: Array) -> str:
    """'#rrggbb' as the cube's space encodes linear RGB (3,)."""
    return "#" + "".join(f"{code:02x}" for code in _codes(cube, rgb))


def triple(rgb: Iterable[float]) -> str:
    return " ".join(f"{value:.6f}" for value in rgb)


def sparkline(reflectance: Array, width: int = 40) -> str:
    """The spectrum in eighths of a line, 0 to 1."""
    count = len(reflectance)
    picks = [round(i * (count - 1) / max(min(width, count) - 1, 1)) for i in range(min(width, count))]
    return "".join(BLOCKS[round(float(reflectance[pick]) * (len(BLOCKS) - 1))] for pick in picks)


WRITERS: dict[str, Writer] = {"table": as_table, "json": as_json, "csv": as_csv}
