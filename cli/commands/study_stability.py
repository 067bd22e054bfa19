"""``uplift study stability``: where the fit fails."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..output.console import console, json_text
from ..output.progress import progress_bar
from ..params.options import force_option, format_option

if TYPE_CHECKING:
    from uplift.lab.study.stability import RunResult
    from uplift.lab.study.stability_design import DesignSpace

FILES = ("stability.csv", "stability.json", "stability.png")
MACBETH = "atlases/macbeth.txt"


def _numbers(kind: Callable[[str], Any]) -> Callable[..., tuple[Any, ...] | None]:
    """A callback that takes '4,8,16' apart."""

    def parse(context: click.Context, parameter: click.Parameter, text: str | None) -> tuple[Any, ...] | None:
        try:
            return None if text is None else tuple(kind(word.strip()) for word in text.split(","))
        except ValueError as error:
            raise click.BadParameter(f"'{text}' is no list of them, as 4,8,16") from error

    return parse


@click.command("stability")
@click.option("--quick", is_flag=True, help="Small lattices and few values: some seconds a model.")
@click.option("--dims", callback=_numbers(int), metavar="N,…", help="Lattice points along each axis.")
@click.option("--coefficients", callback=_numbers(int), metavar="N,…", help="Moments + 1, 3 to 17.")
@click.option("--spaces", callback=_numbers(str), metavar="NAME,…", help="RGB spaces of colour-science.")
@click.option("--models", callback=_numbers(str), metavar="NAME,…", help="moments, sigmoid.")
@click.option("--thresholds", callback=_numbers(float), metavar="X,…", help="Largest miss, |linear RGB|.")
@click.option(
    "--atlas",
    "files",
    metavar="FILE",
    multiple=True,
    help=f"Atlas beside the made ones; may be repeated. [default: {MACBETH}, if it is here]",
)
@click.option("--atlases", callback=_numbers(str), metavar="NAME,…", help="Of all these: none, or by name.")
@click.option("--drawn", type=int, help="Settings drawn from all combinations, beside the grids.")
@click.option("--peer-dims", callback=_numbers(int), metavar="N,…", help="Lattices of scipy's solver.")
@click.option("-o", "--output", metavar="DIR", help="Folder to write the tables and the heat map to.")
@format_option("table", "json", "csv")
@force_option()
def stability(
    quick: bool, files: tuple[str, ...], output: str | None, style: str, force: bool, **chosen: Any
) -> None:
    """Build over dims, coefficients, models, spaces, thresholds and atlases, and look for points that fail.

    For each build the share of realisable points that are fitted, rounds, points that improvement was tried on, the
    worst point and the time. Not every combination: a grid of each axis against the models and their coefficients,
    and a sample of the rest. Beside ours, the thesis's solver on small lattices: least squares with numeric
    differences, grown from the middle, in moments (c) as the thesis has them and in multipliers (p) as we do.

    Atlases are none, the ColorChecker, and three that are made to be hard: crowded, spiky, noisy. --output writes
    stability.csv, stability.json and the heat map stability.png.

    \b
    Examples:
      uplift study stability --quick
      uplift study stability --output out --force
      uplift study stability --spaces 'sRGB,ProPhoto RGB' --thresholds 1e-4,1e-6 --dims 9 --format csv
    """
    from ..startup import keep_compiled

    keep_compiled()
    from uplift.common.files import check_folder
    from uplift.lab.study import stability_design as design
    from uplift.lab.study.stability import NO_ATLAS, study_stability
    from uplift.lab.study.synthetic_atlases import SYNTHETIC_ATLASES

    from ..params.study_atlases import read_each

    here = () if files or not Path(MACBETH).exists() else (MACBETH,)
    atlases = (read_each(files or here) if files or here else {}) | {
        name: make() for name, make in SYNTHETIC_ATLASES.items()
    }
    given = {name: value for name, value in chosen.items() if value is not None}
    axes = replace(
        design.QUICK_DESIGN if quick else design.DesignSpace(), **({"atlases": (NO_ATLAS, *atlases)} | given)
    )
    if output is not None:
        check_folder(output, FILES, force=force)
    with progress_bar("builds") as progress:
        found = study_stability(design.design(axes), atlases, progress)
    if output is not None:
        _write(axes, found, Path(output), force=force)
    PRINTERS[style](found)


def _write(axes: DesignSpace, found: Sequence[RunResult], folder: Path, *, force: bool) -> None:
    from uplift.common.files import write_text
    from uplift.lab.study.records import write_csv
    from uplift.lab.study.stability_design import grids
    from uplift.lab.study.stability_plots import plot_map

    table, text, picture = (folder / name for name in FILES)
    write_csv([one.record() for one in found], table, force=force)
    write_text(_json(found) + "\n", text, force=force)
    plot_map(grids(axes), {one.setting: one for one in found}, picture, force=force)
    click.echo(f"{folder}: {', '.join(FILES)}", err=True)


def _json(found: Sequence[RunResult]) -> str:
    return json_text([one.record() for one in found])


def _print_json(found: Sequence[RunResult]) -> None:
    click.echo(_json(found))


def _print_csv(found: Sequence[RunResult]) -> None:
    from uplift.lab.study.records import csv_text

    click.echo(csv_text([one.record() for one in found]), nl=False)


def _print_table(found: Sequence[RunResult]) -> None:
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD)
    for heading in ("solver", "model", "dim", "space", "threshold", "atlas"):
        table.add_column(heading, no_wrap=True)
    for heading in ("realisable", "unfitted", "rounds", "calls", "worst", "at", "s"):
        table.add_column(heading, justify="right", no_wrap=True)
    for one in found:
        setting = one.setting
        names = (setting.solver, setting.technique, str(setting.dim), setting.space)
        facts = (f"{one.realisable}", f"{one.unfitted}", f"{one.rounds}", f"{one.calls}", f"{one.worst:.1e}")
        where = f"{one.r:.3f} {one.g:.3f} {one.b:.3f}"
        table.add_row(
            *names,
            f"{setting.threshold:g}",
            Text(setting.atlas),
            *facts,
            where,
            f"{one.seconds:.2f}",
            style="bold red" if one.unfitted else None,
        )
    console().print(table)
    failed = [one for one in found if one.unfitted]
    click.echo(
        f"{len(found)} builds, {sum(one.realisable for one in found)} realisable points: "
        f"{sum(one.unfitted for one in failed)} unfitted in {len(failed)} builds"
    )


PRINTERS: dict[str, Callable[[Sequence[RunResult]], None]] = {
    "table": _print_table,
    "json": _print_json,
    "csv": _print_csv,
}
