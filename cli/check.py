"""``uplift check``: stored cubes against their rebuilding, for CI."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from .options import format_option, verbosity_options

if TYPE_CHECKING:
    from uplift.report.regression import Comparison


@click.command("check")
@click.argument("files", nargs=-1, required=True)
@click.option(
    "--atlas-dir", "folders", multiple=True, metavar="DIR", help="Where the atlases lie; may be repeated."
)
@click.option("--update", is_flag=True, help="Replace the cubes that differ by what is built now.")
@format_option("table", "json")
@verbosity_options
def command(
    files: tuple[str, ...], folders: tuple[str, ...], update: bool, style: str, quiet: bool, verbose: bool
) -> None:
    """Rebuild stored cubes from their recorded options and compare.

    \b
    Examples:
      uplift check cubes/*.uplift
      uplift check cubes/*.uplift --atlas-dir atlases --format json
      uplift check cubes/*.uplift --update

    Compared are the lattice RGB, the spectra (largest and rms difference), their ΔE00 under D65, A and
    FL11, and the number of points of each status. Exit code 0: all within their limits; 1: some are not.
    Atlases are looked for by name and content in --atlas-dir, beside the cube, here, and in 'atlases'.
    """
    from .startup import keep_compiled

    keep_compiled()
    from uplift.report.regression import check

    from .progress import watching

    with watching(quiet=quiet, verbose=verbose) as watch:
        comparisons = [check(file, folders, watch) for file in files]
    if style == "json":
        click.echo(json.dumps([_object(comparison) for comparison in comparisons], indent=2))
    elif not quiet:
        _table(comparisons)
    failed = [comparison for comparison in comparisons if comparison.failures]
    if update:
        _update([comparison.path for comparison in failed], folders, quiet=quiet)
    elif failed:
        raise SystemExit(1)


def _update(paths: Sequence[Path], folders: Sequence[str], *, quiet: bool) -> None:
    from uplift.lookup import load
    from uplift.report.regression import rebuild

    for path in paths:
        rebuild(path, load(path), folders).save(path, force=True)
        if not quiet:
            click.echo(f"{path}: replaced", err=True)


def _object(comparison: Comparison) -> dict[str, object]:
    return {
        "cube": str(comparison.path),
        "passed": not comparison.failures,
        "failures": list(comparison.failures),
        "measures": comparison.measures,
        "status": {"stored": comparison.stored_counts, "rebuilt": comparison.rebuilt_counts},
    }


def _table(comparisons: Sequence[Comparison]) -> None:
    from rich.console import Console
    from rich.table import Table

    from uplift.report.regression import LIMITS

    table = Table(box=None, pad_edge=False)
    headings = {"rgb": "RGB", "spectra_max": "spectra max", "spectra_rms": "rms"}
    table.add_column("cube", overflow="fold")
    for name in LIMITS:
        table.add_column(headings.get(name, name.replace("delta_e_", "ΔE00 ")), justify="right", no_wrap=True)
    table.add_column("status", no_wrap=True)
    table.add_column("", no_wrap=True)
    for comparison in comparisons:
        table.add_row(*_row(comparison))
    table.add_row(
        "[dim]limit[/dim]", *(f"[dim]{limit:.0e}[/dim]" for limit in LIMITS.values()), "[dim]same[/dim]", ""
    )
    Console().print(table)


def _row(comparison: Comparison) -> list[str]:
    from uplift.report.regression import LIMITS

    def cell(name: str, text: str) -> str:
        return f"[bold red]{text}[/]" if name in comparison.failures else text

    measures = [cell(name, f"{comparison.measures[name]:.1e}") for name in LIMITS]
    status = cell("status", "same" if "status" not in comparison.failures else "differs")
    verdict = "[bold red]FAILED[/]" if comparison.failures else "[green]passed[/]"
    return [str(comparison.path), *measures, status, verdict]
