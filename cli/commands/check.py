"""``uplift check``: compare stored cubes with rebuilt ones, for continuous integration."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..output.console import console, json_text
from ..params.options import atlas_folders_option, format_option, quiet_option, verbose_option
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from uplift.report.regression import RebuildDifference


@click.command("check")
@click.argument("files", nargs=-1, required=True)
@atlas_folders_option()
@click.option("--update", is_flag=True, help="Replace the cubes that differ by the rebuilt ones.")
@format_option("table", "json")
@quiet_option()
@verbose_option()
def command(
    files: tuple[str, ...], folders: tuple[str, ...], update: bool, style: str, quiet: bool, verbose: bool
) -> None:
    """Rebuild stored cubes from their recorded options and compare the results.

    \b
    Examples:
      uplift check cubes/*.uplift
      uplift check cubes/*.uplift --atlas-dir atlases --format json
      uplift check cubes/*.uplift --update

    The comparison covers lattice RGB, spectra (largest and rms difference), ΔE00 under D65, A and FL11, and the number
    of nodes by status. The exit code is 0 if all differences are within their limits and 1 otherwise.

    Atlases are identified by name and content. They are searched for in --atlas-dir, the cube's folder, the current
    folder, 'atlases' and the shipped atlases.
    """
    enable_jit_cache()
    from uplift.lookup import load
    from uplift.pipeline.rebuild import rebuild
    from uplift.report.regression import compare_rebuilt

    from ..output.progress import build_progress

    stored = {Path(file): load(file) for file in files}
    with build_progress(quiet=quiet, verbose=verbose) as progress:
        rebuilt = {path: rebuild(cube, path, folders, progress=progress) for path, cube in stored.items()}
    comparisons = [compare_rebuilt(path, cube.data, rebuilt[path].data) for path, cube in stored.items()]
    if style == "json":
        click.echo(json_text([_object(comparison) for comparison in comparisons]))
    elif not quiet:
        _table(comparisons)
    failed = [comparison.path for comparison in comparisons if comparison.failures]
    if failed and not update:
        raise SystemExit(1)
    for path in failed:
        rebuilt[path].save(path, force=True)
        click.echo(f"{path}: replaced", err=True)


def _object(comparison: RebuildDifference) -> dict[str, object]:
    return {
        "cube": str(comparison.path),
        "passed": not comparison.failures,
        "failures": list(comparison.failures),
        "measures": comparison.measures,
        "status": {"stored": comparison.stored_counts, "rebuilt": comparison.rebuilt_counts},
    }


def _table(comparisons: Sequence[RebuildDifference]) -> None:
    from rich.table import Table

    from uplift.report.regression import LIMITS

    table = Table(box=None, pad_edge=False)
    headings = {"rgb": "RGB", "spectra_max": "spectra max", "spectra_rms": "rms"}
    table.add_column("cube", no_wrap=True)
    for name in LIMITS:
        table.add_column(headings.get(name, name.replace("delta_e_", "ΔE00 ")), justify="right", no_wrap=True)
    table.add_column("status", no_wrap=True)
    table.add_column("", no_wrap=True)
    for comparison in comparisons:
        table.add_row(*_row(comparison))
    table.add_row(
        "[dim]limit[/dim]", *(f"[dim]{limit:.0e}[/dim]" for limit in LIMITS.values()), "[dim]same[/dim]", ""
    )
    console().print(table)


def _row(comparison: RebuildDifference) -> list[str]:
    from rich.markup import escape

    from uplift.report.regression import LIMITS

    def cell(name: str, text: str) -> str:
        return f"[bold red]{text}[/]" if name in comparison.failures else text

    measures = [cell(name, f"{comparison.measures[name]:.1e}") for name in LIMITS]
    status = cell("status", "same" if "status" not in comparison.failures else "differs")
    verdict = "[bold red]FAILED[/]" if comparison.failures else "[green]passed[/]"
    return [escape(str(comparison.path)), *measures, status, verdict]
