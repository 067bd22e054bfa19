"""``uplift check``: compare stored cubes with rebuilt ones, for continuous integration."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from uplift.common.errors import UpliftError

from ..completion import complete_cube
from ..options import atlas_folders_option, format_option, quiet_option, verbose_option
from ..output.console import make_table, print_json, say, show
from ..output.diagnostics import CommandFailure, error_object
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from rich.text import Text

    from uplift.common.progress import ProgressCallback
    from uplift.lookup import Cube
    from uplift.report.regression import RebuildDifference


@click.command("check")
@click.argument("files", nargs=-1, required=True, shell_complete=complete_cube)
@atlas_folders_option
@click.option("--update", is_flag=True, help="Replace the cubes that differ by the rebuilt ones.")
@format_option("table", "json")
@quiet_option
@verbose_option
def command(
    files: tuple[str, ...], folders: tuple[str, ...], update: bool, style: str, quiet: bool, verbose: bool
) -> None:
    """Rebuild stored cubes from their recorded options and compare the results.

    \b
    Examples:
      uplift check macbeth-32.uplift
      uplift check macbeth-32.uplift --atlas-dir . --format json
      uplift check macbeth-32.uplift --update

    The comparison covers lattice RGB, spectra (largest and rms difference), ΔE00 under D65, A and FL11, and the number
    of nodes by status. The exit code is 0 if all differences are within their limits and 1 otherwise.

    A cube that cannot be read or rebuilt, or that has another lattice, has failed; the others are still checked.
    --update replaces every failed cube that can be rebuilt.

    Atlases are identified by name and content. They are searched for in --atlas-dir, the cube's folder, 'atlases'
    in these, and the shipped atlases.
    """
    enable_jit_cache()
    from ..output.progress import build_progress

    with build_progress(quiet=quiet, verbose=verbose) as progress:
        results = [_check(Path(file), folders, progress) for file in dict.fromkeys(files)]
    if style == "json":
        print_json([_object(result) for result in results])
    elif not quiet:
        _table(results)
    replaced = [result for result in results if update and not result.passed and result.rebuilt]
    failed = [result for result in results if not result.passed and result not in replaced]
    for result in failed:
        if result.error and style != "json":
            CommandFailure(result.error).show()
    for result in replaced:
        result.replace()
    if failed:
        raise SystemExit(1)


@dataclass(frozen=True, eq=False)
class _Result:
    """Result of the check of one cube: a comparison, or the error that prevented it."""

    path: Path
    rebuilt: Cube | None
    comparison: RebuildDifference | None = None
    error: UpliftError | None = None

    @property
    def failures(self) -> tuple[str, ...]:
        """Measures over their limits, or the code of the error."""
        if self.comparison:
            return self.comparison.failures
        return (self.error.code,) if self.error else ()

    @property
    def passed(self) -> bool:
        return not self.failures

    def replace(self) -> None:
        """Replace the stored cube by the rebuilt one."""
        if self.rebuilt:
            self.rebuilt.save(self.path, force=True)
            say(f"{self.path}: replaced", err=True)


def _check(path: Path, folders: Sequence[str], progress: ProgressCallback) -> _Result:
    from uplift.lookup import load
    from uplift.pipeline.rebuild import rebuild
    from uplift.report.regression import compare_rebuilt

    rebuilt = None
    try:
        stored = load(path)
        rebuilt = rebuild(stored, path, folders, progress=progress)
        return _Result(path, rebuilt, comparison=compare_rebuilt(path, stored.data, rebuilt.data))
    except UpliftError as error:
        return _Result(path, rebuilt, error=error)


def _object(result: _Result) -> dict[str, object]:
    comparison, error = result.comparison, result.error
    return {
        "cube": str(result.path),
        "passed": result.passed,
        "failures": list(result.failures),
        "measures": comparison.measures if comparison else {},
        "status": {"stored": comparison.stored_counts, "rebuilt": comparison.rebuilt_counts} if comparison else {},
        "error": error_object(error) if error else None,
    }


def _table(results: Sequence[_Result]) -> None:
    from uplift.report.regression import LIMITS

    headings = {"rgb": "RGB", "spectra_max": "spectra", "spectra_rms": "rms"}
    measures = (headings.get(name, name.replace("delta_e_", "ΔE ")) for name in LIMITS)
    table = make_table()
    table.add_column("cube", no_wrap=True)
    for measure in measures:
        table.add_column(measure, justify="right", no_wrap=True)
    table.add_column("nodes", no_wrap=True)
    table.add_column("verdict", no_wrap=True)
    for result in results:
        table.add_row(*_row(result))
    table.add_row("limit", *(f"{limit:.0e}" for limit in LIMITS.values()), "same", "", style="dim")
    show(table)


def _row(result: _Result) -> list[str | Text]:
    from rich.text import Text

    from uplift.report.regression import LIMITS

    def cell(name: str, text: str) -> Text:
        return Text(text, style="bold red" if name in result.failures else "")

    if result.comparison:
        cells = [cell(name, f"{result.comparison.measures[name]:.1e}") for name in LIMITS]
        cells.append(cell("status", "differs" if "status" in result.failures else "same"))
    else:
        cells = [Text("–")] * (len(LIMITS) + 1)
    verdict = Text("passed", style="green") if result.passed else Text("FAILED", style="bold red")
    return [str(result.path), *cells, verdict]
