"""``uplift study stability``: settings for which nodes stay unfitted."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..output.console import console, json_text
from ..output.progress import progress_bar
from ..params.atlases import read_atlases
from ..params.options import force_option, format_option
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from uplift.lab.study.stability import RunResult
    from uplift.lab.study.stability_design import DesignSpace

FILES = ("stability.csv", "stability.json", "stability.png")
MACBETH = "atlases/macbeth.txt"


def _list_of(kind: Callable[[str], Any]) -> Callable[..., tuple[Any, ...] | None]:
    """Return a callback that parses a list such as '4,8,16'."""

    def parse(context: click.Context, parameter: click.Parameter, text: str | None) -> tuple[Any, ...] | None:
        try:
            return None if text is None else tuple(kind(word.strip()) for word in text.split(","))
        except ValueError as error:
            raise click.BadParameter(f"'{text}' is not a list of such values, as 4,8,16") from error

    return parse


@click.command("stability")
@click.option("--quick", is_flag=True, help="Small lattices and few values: some seconds per model.")
@click.option("--dims", callback=_list_of(int), metavar="N,…", help="Lattice nodes along each axis.")
@click.option(
    "--coefficients", callback=_list_of(int), metavar="N,…", help="Coefficients per spectrum, 3 to 17."
)
@click.option("--spaces", callback=_list_of(str), metavar="NAME,…", help="RGB spaces of colour-science.")
@click.option("--models", callback=_list_of(str), metavar="NAME,…", help="moments, sigmoid.")
@click.option(
    "--thresholds", callback=_list_of(float), metavar="X,…", help="Largest residuals, |linear RGB|."
)
@click.option(
    "--atlas",
    "files",
    metavar="FILE",
    multiple=True,
    help=f"Atlas in addition to the synthetic ones; repeatable. [default: {MACBETH} if it exists]",
)
@click.option(
    "--atlases", callback=_list_of(str), metavar="NAME,…", help="Atlases to use by name, or 'none'."
)
@click.option("--samples", type=int, help="Number of random settings in addition to the grids.")
@click.option(
    "--peer-dims",
    "solver_dims",
    callback=_list_of(int),
    metavar="N,…",
    help="Lattices for the solver of scipy.",
)
@click.option("-o", "--output", metavar="DIR", help="Folder for the tables and the heat map.")
@format_option("table", "json", "csv")
@force_option()
def stability(
    quick: bool, files: tuple[str, ...], output: str | None, style: str, force: bool, **options: Any
) -> None:
    """Build cubes over dims, coefficients, models, spaces, thresholds and atlases, and count unfitted nodes.

    Reports for each build the realisable and the unfitted nodes, rounds, improvement attempts, the largest residual and
    the time. The builds are a grid of each setting against models and coefficients, and a random sample of other
    combinations. For comparison, small lattices are solved by the method of the thesis: least squares with numeric
    derivatives, grown from the centre, in moments (c) and in multipliers (p).

    Atlases are none, the ColorChecker, and three difficult synthetic ones: crowded, spiky and noisy. --output writes
    stability.csv, stability.json and the heat map stability.png.

    \b
    Examples:
      uplift study stability --quick
      uplift study stability --output out --force
      uplift study stability --spaces 'sRGB,ProPhoto RGB' --thresholds 1e-4,1e-6 --dims 9 --format csv
    """
    enable_jit_cache()
    from uplift.common.files import check_folder
    from uplift.lab.study import stability_design as design
    from uplift.lab.study.stability import NO_ATLAS, study_stability
    from uplift.lab.study.synthetic_atlases import SYNTHETIC_ATLASES

    if not files and Path(MACBETH).exists():
        files = (MACBETH,)
    measured = read_atlases(files) if files else {}
    atlases = measured | {name: make() for name, make in SYNTHETIC_ATLASES.items()}
    given = {name: value for name, value in options.items() if value is not None}
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
    plot_map(grids(axes), {one.config: one for one in found}, picture, force=force)
    click.echo(f"{folder}: {', '.join(FILES)}", err=True)


def _json(found: Sequence[RunResult]) -> str:
    return json_text([one.record() for one in found])


def _print_json(found: Sequence[RunResult]) -> None:
    click.echo(_json(found))


def _print_csv(found: Sequence[RunResult]) -> None:
    from uplift.lab.study.records import records_csv

    click.echo(records_csv([one.record() for one in found]), nl=False)


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
        setting = one.config
        names = (setting.solver, setting.model_label, str(setting.dim), setting.space)
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
        f"{len(found)} builds, {sum(one.realisable for one in found)} realisable nodes: "
        f"{sum(one.unfitted for one in failed)} unfitted in {len(failed)} builds"
    )


PRINTERS: dict[str, Callable[[Sequence[RunResult]], None]] = {
    "table": _print_table,
    "json": _print_json,
    "csv": _print_csv,
}
