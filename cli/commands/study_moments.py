"""``uplift study moments``: errors of measured spectra reconstructed from trigonometric moments."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..inputs import DEFAULT_ATLASES, read_atlases
from ..options import Whole, atlas_option, force_option, format_option, output_folder_option
from ..output.console import make_table, print_csv_text, print_json, say, show
from ..output.progress import progress_bar

if TYPE_CHECKING:
    from uplift.lab.study.moments import MomentsStudy

FILES = ("moments.csv", "moments.png", "moments-patches.png", "moments-worst.png")


@click.command("moments")
@atlas_option("Atlas", DEFAULT_ATLASES)
@click.option(
    "--max-moments",
    metavar="N",
    type=Whole(),
    default=15,
    show_default=True,
    help="Largest number of moments, up to 32.",
)
@output_folder_option
@format_option("table", "json", "csv")
@force_option
def moments(files: tuple[str, ...], max_moments: int, output: str | None, style: str, force: bool) -> None:
    """Reconstruct measured spectra from their moments and compare them with the measurements.

    Tests 0 to N moments of mirrored and unmirrored, warped and unwarped spectra, for all atlases together and for each
    (Tódová 2020, table 4.1 and appendix B.1). Errors are mean and largest ΔE76 under D65, ΔE00 under D65, A, FL2, FL7,
    FL11 and LED-B3, and the rms difference. The table shows ΔE76 of all atlases together; JSON and CSV have all errors.

    --output writes moments.csv and, as PNG, the errors over the number of floats (moments), the patches of the thesis
    or the first two entries (moments-patches), and the entries with the largest errors (moments-worst).

    \b
    Examples:
      uplift study moments
      uplift study moments --atlas macbeth --output moments --force
      uplift study moments --max-moments 8 --format json
    """
    from uplift.common.files import check_folder
    from uplift.lab.study.moments import study_moments

    atlases = read_atlases(files)
    if output is not None:
        check_folder(output, FILES, inputs=files, force=force)
    with progress_bar("reconstructions") as progress:
        study = study_moments(atlases, max_moments, progress)
    if output is not None:
        _write(study, Path(output), force=force)
    PRINTERS[style](study)


def _write(study: MomentsStudy, folder: Path, *, force: bool) -> None:
    from uplift.lab.records import write_csv
    from uplift.lab.study.moments import records
    from uplift.lab.study.moments_plots import curves, plot_errors, plot_patches, plot_worst

    table, errors, patches, worst = (folder / name for name in FILES)
    write_csv(records(study), table, force=force)
    plot_errors({"all entries": curves(study)}, errors, force=force)
    plot_patches(study, patches, force=force)
    plot_worst(study, worst, force=force)
    say(f"{folder}: {', '.join(FILES)}", err=True)


def _print_json(study: MomentsStudy) -> None:
    from uplift.lab.study.moments import records

    print_json(records(study))


def _print_csv(study: MomentsStudy) -> None:
    from uplift.lab.records import records_csv
    from uplift.lab.study.moments import records

    print_csv_text(records_csv(records(study)))


def _print_table(study: MomentsStudy) -> None:
    from uplift.lab.study.moments import TECHNIQUES

    caption = (
        f"mean / largest ΔE76 under D65 of {len(study.names)} entries; "
        "n moments take n + 1 floats mirrored, 2n + 1 unmirrored"
    )
    headings = ("moments", *(technique.label for technique in TECHNIQUES))
    table = make_table((), headings, caption=caption)
    for count in range(study.max_moments + 1):
        results = [study.result(technique, count) for technique in TECHNIQUES]
        table.add_row(str(count), *(f"{one.mean[0]:.2f} / {one.max[0]:6.2f}" for one in results))
    show(table)


PRINTERS: dict[str, Callable[[MomentsStudy], None]] = {
    "table": _print_table,
    "json": _print_json,
    "csv": _print_csv,
}
