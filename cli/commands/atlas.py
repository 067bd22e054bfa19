"""``uplift atlas``: list shipped atlases, or entries; convert between formats."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict
from functools import partial
from typing import TYPE_CHECKING, Any

import click

from uplift.common.text import pluralise

from .. import options, sensor_options
from ..output.answers import as_lists
from ..output.console import has_colours, paragraph, print_fields, say
from ..output.table import Table, print_result, swatch
from ..outputs import check_outputs

if TYPE_CHECKING:
    from rich.text import Text

    from uplift.atlas.atlas import Atlas
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.colorimetry.sensor import Sensor

SHIPPED = ("name", "entries", "content", "source", "licence")
"""Columns of the list of shipped atlases."""
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
@click.argument("files", metavar="[FILE]...", nargs=-1, type=options.ATLAS)
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
    rows, smallest = _list_entries(atlas, target, camera["illuminant"])
    fields = {
        **_pick(target, camera),
        "sources": [_pick(source, SOURCE) for source in atlas.sources],
        "smallest_space": smallest,
        "entries": rows,
        "skipped": list(map(asdict, atlas.skipped)),
    }
    headings = {"name": "name", "start": "nm", "end": "to", "step": "step"}
    headings["rgb"] = f"linear {target.space} under {target.illuminant}"
    show = partial(_show_rgb, target)
    print_result(
        style, fields, Table(rows, headings, digits="g", formats={"rgb": show})
    )
    if style == "table":
        _print_notes(atlas, target, rows, smallest)


def _pick(item: object, names: Iterable[str]) -> dict[str, Any]:
    """Return some attributes by their names."""
    return {name: getattr(item, name) for name in names}


def _print_shipped(style: str) -> None:
    from uplift.atlas.sources import shipped_atlases

    atlases = shipped_atlases()
    if style == "table":
        for atlas in atlases:
            print_fields(
                {atlas.name: atlas.content, "": f"{atlas.source}. {atlas.licence}"}
            )
        say()
        paragraph("Use a name as --atlas NAME, or in place of FILE.")
        return
    rows = [_pick(atlas, SHIPPED) for atlas in atlases]
    files = [{"path": str(atlas.path), "digest": atlas.digest} for atlas in atlases]
    with_files = [row | file for row, file in zip(rows, files, strict=True)]
    print_result(style, {"atlases": with_files}, Table(rows))


def _list_entries(
    atlas: Atlas, sensor: Sensor, illuminant: Illuminant
) -> tuple[list[dict[str, Any]], str | None]:
    """List entries, with reflectances clipped as in a build, and `smallest_space`."""
    from uplift.atlas.resampling import resample
    from uplift.colorimetry.observer import smallest_space
    from uplift.colorimetry.sensor import in_unit_cube

    resampled = resample(atlas, sensor.wavelengths)
    clips = {clip.name: [str(clip)] for clip in resampled.clips}
    rows = [
        {
            "name": entry.name,
            "start": float(entry.wavelengths[0]),
            "end": float(entry.wavelengths[-1]),
            "step": entry.step,
            "rgb": as_lists(rgb),
            "in_gamut": bool(in_unit_cube(rgb)),
            "warnings": clips.get(entry.name, []),
        }
        for entry, rgb in zip(atlas.entries, sensor.rgb(resampled.values), strict=True)
    ]
    return rows, smallest_space(resampled.values, illuminant, sensor.observer)


def _show_rgb(sensor: Sensor, rgb: list[float]) -> str | Text:
    text = " ".join(map("{: .4f}".format, rgb))
    if not has_colours():
        return text
    import numpy as np

    from uplift.extras.colour.srgb import hex_codes

    (code,) = hex_codes(np.array([rgb]), sensor)
    return swatch(code, text)


def _print_notes(
    atlas: Atlas, sensor: Sensor, rows: list[dict[str, Any]], smallest: str | None
) -> None:
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


def _count(names: list[str], label: str) -> str:
    return f"{len(names)} {label}" + (f" ({', '.join(names)})" if names else "")
