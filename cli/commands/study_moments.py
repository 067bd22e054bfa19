"""``uplift study moments``: what trigonometric moments keep of measured spectra."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..output.console import console, json_text
from ..output.progress import progress_bar
from ..params.options import force_option, format_option
from ..params.study_atlases import SHIPPED, read_each

if TYPE_CHECKING:
    from uplift.lab.study.moments import MomentsStudy

FILES = ("moments.csv", "moments.png", "moments-patches.png", "moments-worst.png")


@click.command("moments")
@click.option(
    "--atlas", "files", metavar="FILE", multiple=True, help=f"Atlas; may be repeated. [default: {SHIPPED}]"
)
@click.option("--most", metavar="N", type=int, default=15, show_default=True, help="Moments, up to 32.")
@click.option("-o", "--output", metavar="DIR", help="Folder to write the table and the pictures to.")
@format_option("table", "json", "csv")
@force_option()
def moments(files: tuple[str, ...], most: int, output: str | None, style: str, force: bool) -> None:
    """Reduce measured spectra to their moments, reconstruct them, and compare.

    Four techniques, the spectrum mirrored or not and warped or not, with 0 to N moments: mean and largest
    ΔE76 under D65, ΔE00 under D65, A, FL2, FL7, FL11 and LED-B3, and rms difference, of all atlases together
    and of each (Tódová 2020, table 4.1 and appendix B.1). The table shows ΔE76 of all together; JSON and CSV
    hold everything.

    --output writes moments.csv, and as PNG the errors over the numbers stored (moments), the patches that
    the thesis shows or the first two entries (moments-patches), and the worst entries (moments-worst).

    \b
    Examples:
      uplift study moments
      uplift study moments --atlas atlases/macbeth.txt --output out --force
      uplift study moments --most 8 --format json
    """
    from uplift.common.files import check_folder
    from uplift.lab.study.moments import study_moments

    atlases = read_each(files)
    if output is not None:
        check_folder(output, FILES, force=force)
    with progress_bar("reconstructions") as progress:
        found = study_moments(atlases, most, progress)
    if output is not None:
        _write(found, Path(output), force=force)
    PRINTERS[style](found)


def _write(found: MomentsStudy, folder: Path, *, force: bool) -> None:
    from uplift.lab.study.moments_plots import curves, plot_errors, plot_patches, plot_worst
    from uplift.lab.study.moments_table import records
    from uplift.lab.study.records import write_csv

    table, errors, patches, worst = (folder / name for name in FILES)
    write_csv(records(found), table, force=force)
    plot_errors({"all entries": curves(found)}, errors, force=force)
    plot_patches(found, patches, force=force)
    plot_worst(found, worst, force=force)
    click.echo(f"{folder}: {', '.join(FILES)}", err=True)


def _print_json(found: MomentsStudy) -> None:
    from uplift.lab.study.moments_table import records

    click.echo(json_text(records(found)))


def _print_csv(found: MomentsStudy) -> None:
    from uplift.lab.study.moments_table import records
    from uplift.lab.study.records import csv_text

    click.echo(csv_text(records(found)), nl=False)


def _print_table(found: MomentsStudy) -> None:
    from rich import box
    from rich.table import Table

    from uplift.lab.study.technique import TECHNIQUES

    caption = (
        f"mean / largest ΔE76 under D65 of {len(found.names)} entries\n"
        "n moments take n + 1 floats mirrored, 2n + 1 unmirrored"
    )
    table = Table(box=box.SIMPLE_HEAD, caption=caption)
    table.add_column("moments", justify="right")
    for technique in TECHNIQUES:
        table.add_column(technique.label.replace(" ", "\n"), justify="right", no_wrap=True)
    for count in range(found.most + 1):
        results = [found.of(technique, count) for technique in TECHNIQUES]
        table.add_row(str(count), *(f"{one.mean[0]:.2f} / {one.most[0]:6.2f}" for one in results))
    console().print(table)


PRINTERS: dict[str, Callable[[MomentsStudy], None]] = {
    "table": _print_table,
    "json": _print_json,
    "csv": _print_csv,
}
