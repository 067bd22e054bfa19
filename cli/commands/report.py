"""``uplift report``: how good a cube is, as a page to read or as numbers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..output.console import json_text
from ..params.options import atlas_folders_option, force_option, format_option

if TYPE_CHECKING:
    from uplift.atlas import Atlas
    from uplift.lookup import Cube
    from uplift.report.assessment import Assessment


@click.command("report")
@click.argument("cube_path", metavar="CUBE", type=click.Path())
@click.option(
    "--atlas",
    "atlases",
    multiple=True,
    metavar="OTHER",
    help="Judge the cube by these measured spectra, not by its own; may be repeated.",
)
@atlas_folders_option()
@click.option(
    "--light",
    "lights",
    multiple=True,
    help="Light to look under; may be repeated. [default: D65 A FL2 FL7 FL11 LED-B3]",
)
@click.option("-o", "--output", metavar="FILE", help="File to write. [default: CUBE's name with .html, here]")
@format_option("html", "json")
@click.option(
    "--worst", type=click.IntRange(0), default=24, show_default=True, help="Entries whose spectra are drawn."
)
@force_option()
def command(
    cube_path: str,
    atlases: tuple[str, ...],
    folders: tuple[str, ...],
    lights: tuple[str, ...],
    output: str | None,
    style: str,
    worst: int,
    force: bool,
) -> None:
    """Tell how good a cube is: failures, errors, crowding, and every atlas entry beside its measurement.

    The page holds all it needs, its plots included. With --format json the same numbers go to standard
    output, or to FILE.

    \b
    Examples:
      uplift report macbeth-32.uplift
      uplift report macbeth-32.uplift --atlas atlases/cie2017.txt -o unseen.html
      uplift report macbeth-32.uplift --light D50 --light FL4 --worst 6
      uplift report macbeth-32.uplift --format json | jq .failures

    The measured spectra are the cube's own atlases, looked for by name and content in --atlas-dir, beside
    the cube, here, and in 'atlases'. Entries of other atlases, given with --atlas, are asked at their own
    colours: that shows what the cube makes of colours it was not built from, and whether its standard errors
    hold.
    """
    from uplift.common.files import check_output, write_text
    from uplift.lookup import load

    from ..output.progress import spinner

    path = _path(output, cube_path, style)
    if path is not None:
        _check_apart(check_output(path, force=force), cube_path)
    cube = load(cube_path)
    with spinner("asking the cube"):
        found = _assess(cube, cube_path, atlases, folders, lights)
        text = _text(found, style, worst)
    if path is None:
        click.echo(text, nl=False)
    else:
        write_text(text, path, force=force)
        click.echo(f"{path}: {_told(found)}")


def _path(output: str | None, cube: str, style: str) -> Path | None:
    """Where to write; None for standard output."""
    if output is not None:
        return Path(output)
    return Path(f"{Path(cube).stem}.html") if style == "html" else None


def _check_apart(path: Path, cube: str) -> None:
    """--force replaces old reports, not the cube."""
    from uplift.common.errors import OutputError

    if path.exists() and Path(cube).exists() and path.samefile(cube):
        raise OutputError("is the cube itself", path=path, hint="name another file with -o")


def _assess(
    cube: Cube, path: str, atlases: tuple[str, ...], folders: tuple[str, ...], lights: tuple[str, ...]
) -> Assessment:
    from uplift.colorimetry.lights import REPORT_LIGHTS
    from uplift.report.assessment import assess

    spectra = _measured(cube, path, atlases, folders)
    return assess(cube, Path(path).name, Path(path).stat().st_size, spectra, lights or REPORT_LIGHTS)


def _measured(cube: Cube, path: str, atlases: tuple[str, ...], folders: tuple[str, ...]) -> Atlas | None:
    from uplift.atlas import read_atlas
    from uplift.pipeline.provenance import recorded_atlas

    return read_atlas(*atlases) if atlases else recorded_atlas(cube.data, path, folders)


def _text(found: Assessment, style: str, worst: int) -> str:
    if style == "json":
        from uplift.report.json_export import to_json

        return json_text(to_json(found)) + "\n"
    from uplift.report.page import page

    return page(found, worst)


def _told(found: Assessment) -> str:
    """The report in a line."""
    from uplift.viz.format import pluralise

    parts = [f"{pluralise(found.failures.missed, 'point')} over the threshold"]
    if found.entries is not None:
        entries = found.entries
        parts.append(pluralise(len(entries.names), "entry", "entries"))
        parts.append(
            f"ΔE00 mean {entries.delta_e.mean():.2f}, worst {entries.worst[0]:.2f} ('{entries.names[0]}')"
        )
    if found.calibration is not None:
        judged = found.calibration
        parts.append(
            f"under {found.data.error_illuminant} {judged.real:.2f}, {judged.stated:.2f} stated (root mean squares)"
        )
    if found.crowding is not None:
        parts.append(pluralise(len(found.crowding.entries.names), "crowded entry", "crowded entries"))
    return ", ".join(parts)
