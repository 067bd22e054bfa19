"""``uplift study stability``: settings for which nodes stay unfitted."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.common.text import format_value, parse_float, parse_whole

from ..inputs import read_atlases
from ..options import Whole, atlas_option, force_option, format_option, output_folder_option
from ..output.console import json_text, make_table, print_csv_text, print_json, say, show
from ..output.progress import progress_bar
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from uplift.lab.study.stability import DesignSpace, RunResult

FILES = ("stability.csv", "stability.json", "stability.png")
MACBETH = "macbeth"


def _list_of(kind: Callable[[str], Any]) -> Callable[..., tuple[Any, ...] | None]:
    """Return a callback that parses a list such as '4,8,16'."""

    def parse(context: click.Context, parameter: click.Parameter, text: str | None) -> tuple[Any, ...] | None:
        try:
            return None if text is None else tuple(kind(word.strip()) for word in text.split(","))
        except ValueError as error:
            raise click.BadParameter(f"{format_value(text)} is not a list of such values, as 4,8,16") from error

    return parse


@click.command("stability")
@click.option("--quick", is_flag=True, help="Small lattices and few values: some seconds per model.")
@click.option("--dims", callback=_list_of(parse_whole), metavar="N,…", help="Lattice nodes along each axis.")
@click.option(
    "--coefficients",
    callback=_list_of(parse_whole),
    metavar="N,…",
    help="Coefficients per spectrum, 3 to 17.",
)
@click.option("--spaces", callback=_list_of(str), metavar="NAME,…", help="RGB spaces of colour-science.")
@click.option("--models", callback=_list_of(str), metavar="NAME,…", help="moments, sigmoid.")
@click.option("--thresholds", callback=_list_of(parse_float), metavar="X,…", help="Largest residuals, |linear RGB|.")
@atlas_option("Atlas in addition to the synthetic ones", MACBETH)
@click.option("--atlases", callback=_list_of(str), metavar="NAME,…", help="Atlases to use by name, or 'none'.")
@click.option("--samples", type=Whole(0, 100_000), help="Number of random settings in addition to the grids.")
@output_folder_option
@format_option("table", "json", "csv")
@force_option
def stability(quick: bool, files: tuple[str, ...], output: str | None, style: str, force: bool, **options: Any) -> None:
    """Build cubes over dims, coefficients, models, spaces, thresholds and atlases, and count unfitted nodes.

    Reports for each build the realisable and the unfitted nodes, rounds, improvement attempts, the largest residual and
    the time. The builds are a grid of each setting against models and coefficients, and a random sample of other
    combinations.

    Atlases are none, the ColorChecker, and three difficult synthetic ones: crowded, spiky and noisy. --output writes
    stability.csv, stability.json and the heat map stability.png.

    \b
    Examples:
      uplift study stability --quick
      uplift study stability --output out --force
      uplift study stability --thresholds 1e-4,1e-6 --dims 9 --format csv
    """
    enable_jit_cache()
    from uplift.common.files import check_folder
    from uplift.lab.study.stability import (
        NO_ATLAS,
        QUICK_DESIGN,
        SYNTHETIC_ATLASES,
        DesignSpace,
        design,
        study_stability,
    )

    atlases = read_atlases(files or (MACBETH,)) | {name: make() for name, make in SYNTHETIC_ATLASES.items()}
    given = {name: value for name, value in options.items() if value is not None}
    axes = replace(QUICK_DESIGN if quick else DesignSpace(), **({"atlases": (NO_ATLAS, *atlases)} | given))
    if output is not None:
        check_folder(output, FILES, inputs=files, force=force)
    with progress_bar("builds") as progress:
        runs = study_stability(design(axes), atlases, progress)
    if output is not None:
        _write(axes, runs, Path(output), force=force)
    PRINTERS[style](runs)


def _write(axes: DesignSpace, runs: Sequence[RunResult], folder: Path, *, force: bool) -> None:
    from uplift.common.files import write_text
    from uplift.lab.records import write_csv
    from uplift.lab.study.stability import grids
    from uplift.lab.study.stability_plots import plot_map

    table, text, picture = (folder / name for name in FILES)
    write_csv([run.record() for run in runs], table, force=force)
    write_text(_json(runs) + "\n", text, force=force)
    plot_map(grids(axes), {run.config: run for run in runs}, picture, force=force)
    say(f"{folder}: {', '.join(FILES)}", err=True)


def _json(runs: Sequence[RunResult]) -> str:
    return json_text([run.record() for run in runs])


def _print_json(runs: Sequence[RunResult]) -> None:
    print_json([run.record() for run in runs])


def _print_csv(runs: Sequence[RunResult]) -> None:
    from uplift.lab.records import records_csv

    print_csv_text(records_csv([run.record() for run in runs]))


def _print_table(runs: Sequence[RunResult]) -> None:
    table = make_table(
        ("model", "dim", "space", "threshold", "atlas"),
        ("realisable", "unfitted", "rounds", "calls", "worst", "at", "s"),
    )
    for run in runs:
        setting = run.config
        names = (setting.model_label, str(setting.dim), setting.space)
        facts = (f"{run.realisable}", f"{run.unfitted}", f"{run.rounds}", f"{run.calls}", f"{run.worst:.1e}")
        where = f"{run.r:.3f} {run.g:.3f} {run.b:.3f}"
        table.add_row(
            *names,
            f"{setting.threshold:g}",
            setting.atlas,
            *facts,
            where,
            f"{run.seconds:.2f}",
            style="bold red" if run.unfitted else None,
        )
    show(table)
    failed = [run for run in runs if run.unfitted]
    say(
        f"{len(runs)} builds, {sum(run.realisable for run in runs)} realisable nodes: "
        f"{sum(run.unfitted for run in failed)} unfitted in {len(failed)} builds"
    )


PRINTERS: dict[str, Callable[[Sequence[RunResult]], None]] = {
    "table": _print_table,
    "json": _print_json,
    "csv": _print_csv,
}
