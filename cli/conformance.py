"""``uplift check --kit`` and ``--renderer``: the conformance kit, and the verdict on
what other programs make of it.
"""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from uplift.colorimetry.illuminants import Illuminant

from .output.console import make_table, paragraph, print_json, say, show
from .output.diagnostics import FAILED_CHECK
from .outputs import check_folder, check_outputs

if TYPE_CHECKING:
    from uplift.extras.report.conformance import Conformance
    from uplift.lookup.cube import Cube

WORST = 5
"""Number of the worst patches that are named."""


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
    if style == "json":
        print_json(_record(conformance, path))
    else:
        _print(conformance, path)
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


def _record(conformance: Conformance, path: str) -> dict[str, Any]:
    worst = []
    for number in conformance.worst(WORST):
        row = {
            "patch": number,
            "name": conformance.chart.names[number],
            "rgb": conformance.chart.rgb[number].tolist(),
            "delta_e": float(conformance.delta_e[number]),
        }
        worst.append(row)
    return {
        "file": path,
        "passed": conformance.passed,
        "light": conformance.light,
        "mode": conformance.mode,
        "delta_e": asdict(conformance.differences),
        "limits": asdict(conformance.limits),
        "brightness": conformance.brightness,
        "explanation": conformance.explanation,
        "worst": worst,
    }


def _print(conformance: Conformance, path: str) -> None:
    record = _record(conformance, path)
    table = make_table(
        (f"ΔE00 under {conformance.light}",), ("mean", "95 %", "largest")
    )
    table.add_row(f"to mode {conformance.mode}", *_cells(record["delta_e"]))
    table.add_row("limit", *_cells(record["limits"]), style="dim")
    worst = make_table(("row, column", "worst patches", "linear RGB"), ("ΔE00",))
    for patch in record["worst"]:
        place = _place(patch["patch"])
        rgb = " ".join(map("{:.4f}".format, patch["rgb"]))
        worst.add_row(place, patch["name"], rgb, f"{patch['delta_e']:.3f}")
    show(table, worst)
    say(f"{path}: {'passed' if conformance.passed else 'FAILED'}")
    if conformance.explanation:
        paragraph(f"These are the colours if {conformance.explanation}.")


def _cells(differences: dict[str, float]) -> list[str]:
    return [f"{value:.3f}" for value in differences.values()]


def _place(number: int) -> str:
    """Return the row and the column of a patch, counted from 1."""
    from uplift.extras.report.conformance_chart import COLUMNS

    row, column = divmod(number, COLUMNS)
    return f"{row + 1}, {column + 1}"
