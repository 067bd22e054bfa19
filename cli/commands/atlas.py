"""``uplift atlas``: list the shipped atlases or the entries of atlases, or convert between formats."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import click

from ..output.atlas_listing import Listing, Row, list_entries
from ..output.console import has_colours, make_table, paragraph, print_csv, print_json, say, show
from ..output.shipped_listing import print_shipped
from ..params.completion import complete_atlas
from ..params.options import force_option, format_option, scale_option, sensor_options

if TYPE_CHECKING:
    from uplift.atlas import Source

    from ..output.tables import SafeTable


@click.command("atlas")
@click.argument("files", metavar="[FILE]...", nargs=-1, shell_complete=complete_atlas)
@scale_option()
@sensor_options
@format_option("table", "json", "csv")
@click.option("-o", "--output", metavar="FILE", type=click.Path(), help="Write all entries to FILE instead of a list.")
@force_option()
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
    from uplift.atlas import read_atlas

    if output is not None:
        _convert(files, scale, output, force)
        return
    atlas = read_atlas(*files, measured=scale)
    from uplift.colorimetry.observer import DEFAULT_OBSERVER, sensor

    PRINTERS[style](list_entries(atlas, sensor(space, illuminant, observer or DEFAULT_OBSERVER)))


def _convert(files: tuple[str, ...], measured: Any, path: str, force: bool) -> None:
    from uplift.atlas import read_atlas, write_atlas
    from uplift.common.files import check_output

    check_output(path, inputs=files, force=force)
    atlas = read_atlas(*files, measured=measured)
    write_atlas(atlas, path, force=force)
    say(f"{path}: {len(atlas)} entries", err=True)


def _print_json(listing: Listing) -> None:
    rows = [{key: value for key, value in asdict(row).items() if key != "swatch"} for row in listing.rows]
    sensor = listing.sensor
    fields = {
        "space": sensor.space,
        "illuminant": sensor.illuminant,
        "observer": sensor.observer,
        "sources": [_source(source) for source in listing.atlas.sources],
        "smallest_space": listing.smallest_space,
        "entries": rows,
        "skipped": [asdict(skipped) for skipped in listing.atlas.skipped],
    }
    print_json(fields)


def _source(source: Source) -> dict[str, Any]:
    names = ("name", "digest", "format", "measured", "notes")
    return {name: getattr(source, name) for name in names}


def _print_csv(listing: Listing) -> None:
    header = ["name", "start", "end", "step", "r", "g", "b", "in_gamut", "warnings"]
    rows = (
        [row.name, row.start, row.end, row.step, *row.rgb, str(row.in_gamut).lower(), "; ".join(row.warnings)]
        for row in listing.rows
    )
    print_csv(header, rows)


def _print_table(listing: Listing) -> None:
    show(_table(listing))
    for row in listing.rows:
        for warning in row.warnings:
            paragraph(f"{row.name}: {warning}")
    for source in listing.atlas.sources:
        paragraph("; ".join((f"{source.name}: {source.format}", *source.notes)))
    paragraph(_summary(listing))


def _table(listing: Listing) -> SafeTable:
    from rich.text import Text

    sensor = listing.sensor
    swatches = has_colours()
    texts = [""] * swatches + ["name", "nm"]
    table = make_table(texts, "RGB", title=f"linear {sensor.space} under {sensor.illuminant}")
    for row in listing.rows:
        red, green, blue = row.swatch
        swatch = [Text("   ", style=f"on rgb({red},{green},{blue})")] * swatches
        table.add_row(*swatch, *_cells(row))
    return table


def _cells(row: Row) -> Iterator[str]:
    yield row.name
    step = "" if row.step is None else f":{row.step:g}"
    yield f"{row.start:g}:{row.end:g}{step}"
    yield from (f"{channel:.4f}" for channel in row.rgb)


def _summary(listing: Listing) -> str:
    outside = [row.name for row in listing.rows if not row.in_gamut]
    skipped = [skipped.name for skipped in listing.atlas.skipped]
    parts = [
        f"{len(listing.rows)} entries",
        _count(outside, f"out of the {listing.sensor.space} gamut"),
        _count(skipped, "skipped"),
    ]
    return ", ".join(parts) + (f"; {_way_out(listing)}" if outside else "")


def _way_out(listing: Listing) -> str:
    if listing.smallest_space is None:
        return "no common RGB space holds all"
    return f"{listing.smallest_space} holds all {len(listing.rows)}"


def _count(names: Sequence[str], label: str) -> str:
    return f"{len(names)} {label}" + (f" ({', '.join(names)})" if names else "")


PRINTERS: dict[str, Callable[[Listing], None]] = {
    "table": _print_table,
    "json": _print_json,
    "csv": _print_csv,
}
