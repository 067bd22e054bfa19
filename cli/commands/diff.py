"""``uplift lab diff``: where two cubes differ."""

from __future__ import annotations

from typing import Any

import click

from uplift.colorimetry.illuminants import Illuminant
from uplift.common.text import pluralise
from uplift.extras.images.sequences import expand_patterns

from .. import options
from ..inputs import read_pictures
from ..output.console import paragraph, say
from ..output.progress import progress_bar
from ..output.table import Table, print_result
from ..outputs import check_outputs

WORST = 5
"""Number of the worst colours of each set that are named and drawn."""


@click.command(
    "diff",
    help="""Compare two cubes: ΔE00 of their answers at nodes, atlas entries, and the
    colours of images.

    \b
    Examples:
      uplift lab diff macbeth-32.uplift sRGB
      uplift lab diff macbeth-32.uplift sRGB wood.png -o wood-diff.html
      uplift build --atlas macbeth --library fabrics.csv -o fabrics.uplift
      uplift lab diff macbeth-32.uplift fabrics.uplift --tolerance 50

    The cubes may have different lattices, models, atlases and ranges, in one RGB space.
    Entries are compared by name. Without --tolerance the exit code is 0.
    """,
)
@click.argument("first", metavar="CUBE", type=options.CUBE)
@click.argument("second", metavar="CUBE", type=options.CUBE)
@click.argument("images", metavar="[IMAGE]...", nargs=-1)
@options.light("Illuminant", "D65 A FL2 FL11 LED-B3")
@options.tolerance(
    help="Largest ΔE00 that is accepted: the exit code is 1 if a colour differs by "
    "more, if one cube alone lacks a colour, or if entries were added or removed."
)
@options.pixels()
@options.output(
    help="HTML page with pictures of where the cubes differ.", type=options.FIGURE_PAGE
)
@options.table_or_json
@options.force
def command(
    first: str,
    second: str,
    images: tuple[str, ...],
    lights: tuple[Illuminant, ...],
    tolerance: float | None,
    output: str | None,
    style: str,
    force: bool,
    **pixels: Any,
) -> None:
    from uplift.colorimetry.illuminants import SCENE_LIGHTS
    from uplift.common.errors import OptionError
    from uplift.common.files import write_text
    from uplift.extras.report.diff import diff_cubes, to_json
    from uplift.lookup.cube import load

    if tolerance is not None and tolerance < 0:
        raise OptionError(f"tolerance must not be negative, got {tolerance:g}")
    paths = expand_patterns(images)
    check_outputs(output, inputs=paths)
    names = (first, second) if first != second else (first, f"{second} (again)")
    cubes = dict(zip(names, map(load, (first, second)), strict=True))
    with progress_bar("comparing answers"):
        read = read_pictures(paths, next(iter(cubes.values())).data.sensor, **pixels)
        pictures = {
            path: picture.rgb.astype(float)
            for path, picture in zip(paths, read, strict=True)
        }
        difference = diff_cubes(cubes, lights or SCENE_LIGHTS, pictures)
        if output is not None:
            from uplift.extras.report.diff_page import render_diff

            write_text(render_diff(difference, pictures, WORST), output, force=force)
    figures = to_json(difference, tolerance, WORST)
    _print(figures, style)
    if output is not None and style != "json":
        say(f"{output}: where they differ")
    if not figures.get("passed", True):
        raise SystemExit(1)


def _print(figures: dict[str, Any], style: str) -> None:
    headings = {"set": "colours", "light": "light"}
    headings |= {"mean": "mean ΔE00", "p95": "95 %", "max": "largest"}
    if "tolerance" in figures:
        headings["moved"] = "moved"
    tables = [Table(figures["differences"], headings)]
    if figures["worst"]:
        rows = [{"entry": row["set"], **row} for row in figures["worst"]]
        headings = {"entry": "worst colours", "rgb": "linear RGB"}
        headings |= {"light": "light", "delta_e": "ΔE00"}
        tables.append(Table(rows, headings, formats={"rgb": ".4f"}))
    print_result(style, figures, *tables)
    if style == "json":
        return
    for change in ("removed", "added"):
        if names := figures[f"entries_{change}"]:
            paragraph(f"entries {change}: {', '.join(names)}")
    for row in figures["lacking"]:
        count = pluralise(row["colours"], "colour")
        say(f"{row['set']}: {row['cubes']} cannot answer {count}")
    if "tolerance" in figures:
        failed = f"FAILED: the tolerance is ΔE00 {figures['tolerance']:g}"
        say("passed" if figures["passed"] else failed)
