"""``uplift check --kit`` and ``--renderer``: the conformance kit, and the verdict on
what other programs make of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from uplift.colorimetry.illuminants import Illuminant

from .output.console import paragraph, say
from .output.diagnostics import FAILED_CHECK
from .output.table import Table, print_result
from .outputs import check_folder, check_outputs

if TYPE_CHECKING:
    from uplift.lookup.cube import Cube

WORST = 5
"""Number of the worst patches that are named."""
FIGURES = {"mean": "mean", "p95": "95 %", "largest": "largest"}


def write(cube: str | None, folder: str, *, force: bool) -> None:
    """Write the kit of a cube, by default its own."""
    from uplift.extras.report.conformance_kit import kit_names, write_kit

    check_folder(folder, kit_names())
    paths = write_kit(_load(cube), folder, force=force)
    say(f"{folder}: {', '.join(path.name for path in paths)}")


def judge(
    cube: str | None,
    path: str,
    light: Illuminant,
    style: str,
    plot_path: str | None,
    *,
    force: bool,
) -> None:
    """Print and draw the verdict on a picture or on spectra; exit with 1 if they
    differ.
    """
    from uplift.extras.report.conformance import check_renderer

    check_outputs(plot_path)
    conformance = check_renderer(path, _load(cube), light)
    record = {"file": path, **conformance.to_json(WORST)}
    rows = [
        {"row": f"to mode {conformance.mode}", **record["delta_e"]},
        {"row": "limit", **record["limits"]},
    ]
    headings = {"row": f"ΔE00 under {conformance.light}"} | FIGURES
    worst = Table(
        record["worst"],
        {
            "patch": "row, column",
            "name": "worst patches",
            "rgb": "linear RGB",
            "delta_e": "ΔE00",
        },
        formats={"rgb": ".4f", "patch": _place},
    )
    print_result(style, record, Table(rows, headings), worst)
    if style != "json":
        say(f"{path}: {'passed' if conformance.passed else 'FAILED'}")
        if conformance.explanation:
            paragraph(f"These are the colours if {conformance.explanation}.")
    if plot_path is not None:
        from uplift.extras.pages.figure import write_figure
        from uplift.extras.report.conformance_plot import plot_conformance

        write_figure(plot_conformance(conformance), plot_path, force=force)
        say(plot_path, err=True)
    if not conformance.passed:
        raise SystemExit(FAILED_CHECK)


def _load(cube: str | None) -> Cube:
    from uplift.extras.report.conformance_kit import build_cube
    from uplift.lookup.cube import load

    return build_cube() if cube is None else load(cube)


def _place(number: int) -> str:
    """Return the row and the column of a patch, counted from 1."""
    from uplift.extras.report.conformance_chart import COLUMNS

    row, column = divmod(number, COLUMNS)
    return f"{row + 1}, {column + 1}"
