"""``uplift atlas``: list the shipped atlases or the entries of atlases, or convert between formats."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import click

from ..completion import complete_atlas
from ..options import force_option, format_option, scale_option, sensor_options
from ..output.console import has_colours, make_table, paragraph, print_csv, print_json, say, show

if TYPE_CHECKING:
    from uplift.atlas import Atlas
    from uplift.colorimetry.sensor import Sensor

SHIPPED = ("name", "entries", "content", "source", "licence")
"""Columns of the list of shipped atlases."""
SOURCE = ("name", "digest", "format", "measured", "notes")
"""Fields of the source of an atlas in JSON."""


@click.command("atlas")
@click.argument("files", metavar="[FILE]...", nargs=-1, shell_complete=complete_atlas)
@scale_option
@sensor_options
@format_option("table", "json", "csv")
@click.option("-o", "--output", metavar="FILE", type=click.Path(), help="Write all entries to FILE instead of a list.")
@force_option
def command(
    files: tuple[str, ...],
    scale: Any,
    space: str,
    illuminant: str,
    observer: str | None,
    style: str,
    output: str | None,
    force: bool,
) -> None:
    """List the entries of atlas files, and how the files were understood.

    Without FILE, lists the atlases that are installed with uplift, with source and licence. Their names are valid
    wherever an atlas file is: where no file of the name exists, the shipped atlas is read.

    An atlas contains measured reflectances: a table with a row or a column per sample (CSV, text, spreadsheets), an
    ART measurement archive, CGATS and Argyll .ti3, CxF3, IES TM-27, JCAMP-DX, or an ENVI library. Several files are
    read as one atlas. --output writes CSV if its name ends in .csv, and an ART measurement archive otherwise.

    \b
    Examples:
      uplift atlas macbeth
      uplift atlas --space "Display P3" --illuminant A macbeth
      uplift atlas --format json paints.csv fabrics.csv
      uplift atlas chart.ti3 paints.cxf
      uplift atlas dark.csv --scale percent
      uplift atlas paints.csv -o paints.txt
    """
    if not files:
        if output is not None:
            raise click.UsageError("--output needs an atlas to write.")
        print_shipped(style)
        return
    from uplift.atlas import read_atlas, write_atlas
    from uplift.colorimetry.observer import DEFAULT_OBSERVER, sensor
    from uplift.common.files import check_output

    if output is not None:
        check_output(output, inputs=files, force=force)
    atlas = read_atlas(*files, measured=scale)
    if output is None:
        PRINTERS[style](_list_entries(atlas, sensor(space, illuminant, observer or DEFAULT_OBSERVER)))
    else:
        write_atlas(atlas, output, force=force)
        say(f"{output}: {len(atlas)} entries", err=True)


def print_shipped(style: str) -> None:
    """Print the shipped atlases as table, JSON or CSV."""
    from uplift.atlas import shipped_atlases

    atlases = shipped_atlases()
    rows = [{name: getattr(atlas, name) for name in SHIPPED} for atlas in atlases]
    if style == "json":
        files = [{"path": str(atlas.path), "digest": atlas.digest} for atlas in atlases]
        print_json({"atlases": [row | file for row, file in zip(rows, files, strict=True)]})
    elif style == "csv":
        print_csv(SHIPPED, (list(row.values()) for row in rows))
    else:
        table = make_table()
        for name in SHIPPED:
            table.add_column(name, justify="right" if name == "entries" else "left", no_wrap=name in SHIPPED[:2])
        for row in rows:
            table.add_row(*map(str, row.values()))
        show(table)
        say()
        paragraph("Use a name as --atlas NAME, or in place of FILE.")


@dataclass(frozen=True)
class Row:
    """One entry: range in nm, linear RGB, 8-bit sRGB, and warnings."""

    name: str
    start: float
    end: float
    step: float | None
    rgb: tuple[float, float, float]
    swatch: tuple[int, int, int]
    in_gamut: bool
    warnings: tuple[str, ...]


@dataclass(frozen=True)
class Listing:
    """An atlas, its colours under one sensor, and the smallest common RGB space that holds all of them."""

    atlas: Atlas
    sensor: Sensor
    rows: tuple[Row, ...]
    smallest_space: str | None


def _list_entries(atlas: Atlas, sensor: Sensor) -> Listing:
    """List all entries under a sensor, with reflectances clipped as in a build."""
    from uplift.atlas import resample
    from uplift.colorimetry.gamut import SRGB
    from uplift.colorimetry.observer import sensor as make_sensor
    from uplift.colorimetry.observer import smallest_space
    from uplift.colorimetry.srgb import to_display_codes

    resampled = resample(atlas, sensor.wavelengths)
    display = make_sensor("sRGB", sensor.illuminant, sensor.observer)
    clips = {clip.name: (str(clip),) for clip in resampled.clips}
    colours = sensor.rgb(resampled.values).tolist()
    codes = to_display_codes(display.rgb(resampled.values), SRGB).astype(int).tolist()
    rows = [
        Row(
            entry.name,
            float(entry.wavelengths[0]),
            float(entry.wavelengths[-1]),
            entry.step,
            tuple(rgb),
            tuple(code),
            bool(sensor.contains(rgb)),
            clips.get(entry.name, ()),
        )
        for entry, rgb, code in zip(atlas.entries, colours, codes, strict=True)
    ]
    smallest = smallest_space(resampled.values, sensor.illuminant, sensor.observer)
    return Listing(atlas, sensor, tuple(rows), smallest)


def _print_json(listing: Listing) -> None:
    rows = [{key: value for key, value in asdict(row).items() if key != "swatch"} for row in listing.rows]
    sensor = listing.sensor
    fields = {
        "space": sensor.space,
        "illuminant": sensor.illuminant,
        "observer": sensor.observer,
        "sources": [{name: getattr(source, name) for name in SOURCE} for source in listing.atlas.sources],
        "smallest_space": listing.smallest_space,
        "entries": rows,
        "skipped": [asdict(skipped) for skipped in listing.atlas.skipped],
    }
    print_json(fields)


def _print_csv(listing: Listing) -> None:
    header = ["name", "start", "end", "step", "r", "g", "b", "in_gamut", "warnings"]
    rows = (
        [row.name, row.start, row.end, row.step, *row.rgb, str(row.in_gamut).lower(), "; ".join(row.warnings)]
        for row in listing.rows
    )
    print_csv(header, rows)


def _print_table(listing: Listing) -> None:
    from rich.text import Text

    sensor = listing.sensor
    swatches = has_colours()
    texts = [""] * swatches + ["name", "nm"]
    table = make_table(texts, "RGB", title=f"linear {sensor.space} under {sensor.illuminant}")
    for row in listing.rows:
        red, green, blue = row.swatch
        swatch = [Text("   ", style=f"on rgb({red},{green},{blue})")] * swatches
        step = "" if row.step is None else f":{row.step:g}"
        rgb = (f"{channel:.4f}" for channel in row.rgb)
        table.add_row(*swatch, row.name, f"{row.start:g}:{row.end:g}{step}", *rgb)
    show(table)
    for row in listing.rows:
        for warning in row.warnings:
            paragraph(f"{row.name}: {warning}")
    for source in listing.atlas.sources:
        paragraph("; ".join((f"{source.name}: {source.format}", *source.notes)))
    paragraph(_summary(listing))


def _summary(listing: Listing) -> str:
    """Return the numbers of entries, of those out of gamut with the space that holds all, and of skipped ones."""
    outside = [row.name for row in listing.rows if not row.in_gamut]
    skipped = [skipped.name for skipped in listing.atlas.skipped]
    text = f"{len(listing.rows)} entries, {_count(outside, f'out of the {listing.sensor.space} gamut')}, "
    text += _count(skipped, "skipped")
    if outside and listing.smallest_space is None:
        text += "; no common RGB space holds all"
    elif outside:
        text += f"; {listing.smallest_space} holds all {len(listing.rows)}"
    return text


def _count(names: Sequence[str], label: str) -> str:
    return f"{len(names)} {label}" + (f" ({', '.join(names)})" if names else "")


PRINTERS: dict[str, Callable[[Listing], None]] = {"table": _print_table, "json": _print_json, "csv": _print_csv}
