"""``uplift report``: assess the quality of a cube."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..completion import complete_cube
from ..options import Whole, atlas_folders_option, atlas_option, force_option, format_option, light_option
from ..output.console import emit, json_text, say
from ..output.progress import spinner

if TYPE_CHECKING:
    from uplift.report.assessment import Assessment


@click.command("report")
@click.argument("cube_path", metavar="CUBE", shell_complete=complete_cube)
@atlas_option("Measured spectra that replace the atlases of the cube")
@atlas_folders_option
@light_option("Illuminant to evaluate", "D65 A FL2 FL7 FL11 LED-B3")
@click.option(
    "-o", "--output", metavar="FILE", help="File to write. [default: CUBE's name with .html, in the current folder]"
)
@format_option("html", "json")
@click.option(
    "--worst",
    type=Whole(0),
    default=24,
    show_default=True,
    help="Number of entries with plotted spectra, largest errors first.",
)
@force_option
def command(
    cube_path: str,
    files: tuple[str, ...],
    folders: tuple[str, ...],
    lights: tuple[str, ...],
    output: str | None,
    style: str,
    worst: int,
    force: bool,
) -> None:
    """Assess a cube: failures, errors, crowded entries, and every atlas entry compared with its measurement.

    The HTML page is self-contained. With --format json the same numbers go to standard output, or to FILE.

    \b
    Examples:
      uplift report macbeth-32.uplift
      uplift report macbeth-32.uplift --atlas cie2017 -o unseen.html
      uplift report macbeth-32.uplift --light D50 --light FL4 --worst 6 -o worst.html
      uplift report macbeth-32.uplift --format json | jq .failures

    The measured spectra are those of the cube's atlases. Atlases are identified by name and content, and searched for
    in --atlas-dir, the cube's folder, 'atlases' in these, and the shipped atlases.

    --atlas evaluates entries of other atlases at their own colours. This shows how well the cube predicts unseen
    materials, and whether its standard errors are calibrated.
    """
    from uplift.atlas import read_atlas
    from uplift.colorimetry.lights import REPORT_LIGHTS
    from uplift.common.files import check_output, write_text
    from uplift.lookup import load
    from uplift.pipeline.rebuild import recorded_atlas
    from uplift.report.assessment import assess
    from uplift.report.page import render_report, to_json

    path = None if output is None else Path(output)
    if path is None and style == "html":
        path = Path(f"{Path(cube_path).stem}.html")
    if path is not None:
        check_output(path, inputs=(cube_path, *files), force=force)
    cube = load(cube_path)
    with spinner("evaluating the cube"):
        atlas = read_atlas(*files) if files else recorded_atlas(cube.data, cube_path, folders)
        size = Path(cube_path).stat().st_size
        assessment = assess(cube, Path(cube_path).name, size, atlas, lights or REPORT_LIGHTS)
        text = json_text(to_json(assessment)) + "\n" if style == "json" else render_report(assessment, worst)
    if path is None:
        emit(text, nl=False)
    else:
        write_text(text, path, force=force)
        say(f"{path}: {_summary(assessment)}")


def _summary(assessment: Assessment) -> str:
    """Return the main numbers on one line."""
    from uplift.viz.format import pluralise

    parts = [f"{pluralise(assessment.failures.over_threshold, 'node')} over the threshold"]
    if assessment.entries is not None:
        entries = assessment.entries
        parts.append(pluralise(len(entries.names), "entry", "entries"))
        parts.append(f"ΔE00 mean {entries.delta_e.mean():.2f}, worst {entries.worst[0]:.2f} ('{entries.names[0]}')")
    if assessment.calibration is not None:
        calibration, light = assessment.calibration, assessment.data.error_illuminant
        parts.append(f"68 % within {calibration.actual:.2f} under {light}, predicted {calibration.predicted:.2f}")
    if assessment.crowding is not None:
        parts.append(pluralise(len(assessment.crowding.entries.names), "crowded entry", "crowded entries"))
    return ", ".join(parts)
