"""``uplift atlas``: list shipped atlases, or entries; convert between formats."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict
from operator import attrgetter
from typing import TYPE_CHECKING, Any

import click

from uplift.common.text import pluralise

from .. import options, sensor_options
from ..output.answers import as_lists
from ..output.console import (
    has_colours,
    make_table,
    paragraph,
    print_csv,
    print_fields,
    print_json,
    say,
    show,
    swatch,
)
from ..outputs import check_outputs

if TYPE_CHECKING:
    from uplift.atlas.atlas import Atlas
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.colorimetry.sensor import Sensor
    from uplift.common.arrays import Array

SHIPPED = ("name", "entries", "content", "source", "licence")
"""Columns of the list of shipped atlases."""
COLUMNS = ("name", "start", "end", "step", *"rgb", "in_gamut", "warnings")
"""Columns of entries in CSV."""
SOURCE = ("name", "digest", "format", "measured", "missing", "notes")
"""Fields of the source of an atlas in JSON."""


@click.command(
    "atlas",
    help="""List the entries of atlas files, and how the files were understood.

    Without FILE, lists the atlases that are installed with uplift, with source and
    licence. Their names are valid wherever an atlas file is: where no file of the name
    exists, the shipped atlas is read.

    An atlas contains measured reflectances: a table with a row or a column per sample
    (CSV, text, spreadsheets), an ART measurement archive, CGATS and Argyll .ti3, CxF3,
    IES TM-27, JCAMP-DX, or an ENVI library. Several files are read as one atlas.
    --output writes CSV if its name ends in .csv, and an ART measurement archive
    otherwise.

    \b
    Examples:
      uplift atlas macbeth
      uplift atlas --space "Display P3" --illuminant A macbeth
      uplift atlas --format json paints.csv fabrics.csv
      uplift atlas chart.ti3 paints.cxf
      uplift atlas dark.csv --scale percent
      uplift atlas paints.csv -o paints.txt
    """,
)
@click.argument(
    "files", metavar="[FILE]...", nargs=-1, shell_complete=options.complete_atlas
)
@options.scale
@options.missing
@sensor_options.sensor
@options.table_json_or_csv
@options.output(help="Write all entries to FILE instead of a list.")
@options.force
def command(
    files: Sequence[str],
    scale: Any,
    missing: Any,
    style: str,
    output: str | None,
    force: bool,
    **camera: Any,
) -> None:
    from uplift.atlas.resampling import resample
    from uplift.atlas.sources import read_atlas, write_atlas
    from uplift.colorimetry.observer import sensor

    if not files:
        if output is not None:
            raise click.UsageError("--output needs an atlas to write.")
        _print_shipped(style)
        return
    target = sensor(**camera)
    check_outputs(output)
    atlas = read_atlas(*files, measured=scale, missing=missing)
    if output is not None:
        write_atlas(atlas, output, force=force)
        for clip in resample(atlas, target.wavelengths).clips:
            paragraph(f"{clip.name}: {clip} in a build", err=True)
        say(f"{output}: {pluralise(len(atlas), 'entry')}", err=True)
        return
    rows, codes, smallest = _list_entries(atlas, target, camera["illuminant"])
    if style == "json":
        fields = {
            **_pick(target, camera),
            "sources": [_pick(source, SOURCE) for source in atlas.sources],
            "smallest_space": smallest,
            "entries": rows,
            "skipped": list(map(asdict, atlas.skipped)),
        }
        print_json(fields)
    elif style == "csv":
        print_csv(COLUMNS, map(_csv_row, rows))
    else:
        _print_table(atlas, target, rows, codes, smallest)


def _pick(item: object, names: Iterable[str]) -> dict[str, Any]:
    """Return some attributes by their names."""
    return {name: getattr(item, name) for name in names}


def _csv_row(row: dict[str, Any]) -> Sequence[Any]:
    *place, rgb, in_gamut, warnings = row.values()
    return [*place, *rgb, str(in_gamut).lower(), "; ".join(warnings)]


def _print_shipped(style: str) -> None:
    from uplift.atlas.sources import shipped_atlases

    atlases = shipped_atlases()
    if style == "json":
        rows = []
        for atlas in atlases:
            file = {"path": str(atlas.path), "digest": atlas.digest}
            rows.append(_pick(atlas, SHIPPED) | file)
        print_json({"atlases": rows})
    elif style == "csv":
        print_csv(SHIPPED, map(attrgetter(*SHIPPED), atlases))
    else:
        for atlas in atlases:
            print_fields(
                {atlas.name: atlas.content, "": f"{atlas.source}. {atlas.licence}"}
            )
        say()
        paragraph("Use a name as --atlas NAME, or in place of FILE.")


def _list_entries(
    atlas: Atlas, sensor: Sensor, illuminant: Illuminant
) -> tuple[list[dict[str, Any]], Array, str | None]:
    """List all entries, with reflectances clipped as in a build; return 8-bit sRGB (n,
    3) and `smallest_space`.
    """
    from uplift.atlas.resampling import resample
    from uplift.colorimetry.gamut import SRGB
    from uplift.colorimetry.observer import sensor as make_sensor
    from uplift.colorimetry.observer import smallest_space
    from uplift.colorimetry.sensor import in_unit_cube
    from uplift.extras.colour.srgb import to_display_codes

    resampled = resample(atlas, sensor.wavelengths)
    display = make_sensor("sRGB", illuminant, sensor.observer)
    clips = {clip.name: (str(clip),) for clip in resampled.clips}
    rows = [
        {
            "name": entry.name,
            "start": float(entry.wavelengths[0]),
            "end": float(entry.wavelengths[-1]),
            "step": entry.step,
            "rgb": as_lists(rgb),
            "in_gamut": bool(in_unit_cube(rgb)),
            "warnings": clips.get(entry.name, ()),
        }
        for entry, rgb in zip(atlas.entries, sensor.rgb(resampled.values), strict=True)
    ]
    codes = to_display_codes(display.rgb(resampled.values), SRGB).astype(int)
    return rows, codes, smallest_space(resampled.values, illuminant, sensor.observer)


def _print_table(
    atlas: Atlas,
    sensor: Sensor,
    rows: Sequence[dict[str, Any]],
    codes: Array,
    smallest: str | None,
) -> None:
    coloured = has_colours()
    texts = [""] * coloured + ["name", "nm"]
    table = make_table(
        texts, "RGB", title=f"linear {sensor.space} under {sensor.illuminant}"
    )
    for row, code in zip(rows, codes.tolist(), strict=True):
        wavelengths = f"{row['start']:g}:{row['end']:g}"
        if row["step"] is not None:
            wavelengths += f":{row['step']:g}"
        rgb = map("{:.4f}".format, row["rgb"])
        table.add_row(*[swatch(code)] * coloured, row["name"], wavelengths, *rgb)
    show(table)
    for row in rows:
        for warning in row["warnings"]:
            paragraph(f"{row['name']}: {warning}")
    for entry in atlas.skipped:
        paragraph(f"{entry.name}: skipped: {entry.reason}")
    for source in atlas.sources:
        paragraph("; ".join((f"{source.name}: {source.format}", *source.notes)))
    outside = [row["name"] for row in rows if not row["in_gamut"]]
    skipped = [entry.name for entry in atlas.skipped]
    text = (
        f"{pluralise(len(rows), 'entry')}, "
        f"{_count(outside, f'out of the {sensor.space} gamut')}, "
        f"{_count(skipped, 'skipped')}"
    )
    if outside and smallest:
        text += f"; {smallest} holds all {len(rows)}"
    elif outside:
        text += "; no common RGB space holds all"
    paragraph(text)


def _count(names: Sequence[str], label: str) -> str:
    return f"{len(names)} {label}" + (f" ({', '.join(names)})" if names else "")
