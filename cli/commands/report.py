"""``uplift report``: assess the quality of a cube."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from .. import options
from ..inputs import check_figure_page
from ..output.console import emit, json_text, paragraph
from ..output.progress import progress_bar
from ..outputs import check_outputs

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.extras.report.assessment import Assessment


@click.command(
    "report",
    help="""Assess a cube: failures, errors, crowded entries, and every atlas entry
    compared with its measurement.

    The HTML page is self-contained. With --format json the same numbers go to standard
    output, or to FILE.

    \b
    Examples:
      uplift report macbeth-32.uplift
      uplift report macbeth-32.uplift --atlas cie2017 -o unseen.html
      uplift report macbeth-32.uplift --light FL4 --worst 6 -o worst.html
      uplift report macbeth-32.uplift --format json | jq .failures

    The measured spectra are those of the cube's atlases, which are found by name and
    content, as by 'uplift check'.

    --atlas evaluates entries of other atlases at their own colours. This shows how well
    the cube predicts unseen materials, and whether its standard errors are calibrated.
    """,
)
@options.cube_argument
@options.atlas("Measured spectra that replace the atlases of the cube")
@options.atlas_folders
@options.light("Illuminant to evaluate", "D65 A FL2 FL7 FL11 LED-B3")
@options.output(
    help="File to write. [default: CUBE's name with .html, in the current folder]"
)
@options.output_format("html", "json")
@click.option(
    "--worst",
    type=options.Whole(0),
    default=24,
    help="Number of entries with plotted spectra, largest errors first.",
)
@options.force
def command(
    cube: str,
    files: tuple[str, ...],
    folders: tuple[str, ...],
    lights: tuple[Illuminant, ...],
    output: str | None,
    style: str,
    worst: int,
    force: bool,
) -> None:
    from uplift.atlas.sources import read_atlas
    from uplift.common.files import write_text
    from uplift.extras.colour.light_sets import REPORT_LIGHTS
    from uplift.extras.report.assessment import assess
    from uplift.extras.report.page import render_report
    from uplift.extras.report.rebuild import recorded_atlas
    from uplift.lookup.cube import find_file, load

    path = output
    if style == "html":
        path = output or f"{Path(cube).stem}.html"
        check_figure_page(path)
    loaded = load(cube)
    atlas = read_atlas(*files) if files else recorded_atlas(loaded.data, cube, folders)
    check_outputs(
        path, inputs=() if atlas is None else {entry.path for entry in atlas.entries}
    )
    with progress_bar("evaluating the cube"):
        size = Path(find_file(cube)).stat().st_size
        assessment = assess(
            loaded, Path(cube).name, size, atlas, lights or REPORT_LIGHTS
        )
        text = (
            json_text(assessment.values) + "\n"
            if style == "json"
            else render_report(assessment, worst)
        )
    if path is None:
        emit(text, nl=False)
    else:
        write_text(text, path, force=force)
        paragraph(f"{path}: {_summary(assessment)}")


def _summary(assessment: Assessment) -> str:
    from uplift.common.text import pluralise

    values = assessment.values
    over = values["failures"]["over_threshold"]
    parts = [f"{pluralise(over, 'node')} over the threshold"]
    if assessment.entries is not None:
        answers = assessment.entries.answers
        parts.append(pluralise(len(values["entries"]), "entry"))
        parts.append(
            f"ΔE00 mean {answers.delta_e.mean():.2f}, worst {answers.worst[0]:.2f} "
            f"('{values['entries'][0]['name']}')"
        )
    errors = values["standard_error"]
    if calibration := errors["calibration"]:
        parts.append(
            f"68 % within {calibration['real']:.2f} under {errors['light']}, predicted "
            f"{calibration['stated']:.2f}"
        )
    if crowding := values["crowding"]:
        parts.append(pluralise(len(crowding["entries"]), "crowded entry"))
    return ", ".join(parts)
