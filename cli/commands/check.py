"""``uplift check``: compare stored cubes with rebuilt ones, for continuous integration."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from uplift.common.errors import UpliftError, UpliftWarning

from .. import options
from ..output.console import make_table, print_json, say, show
from ..output.diagnostics import CommandFailure, error_object
from ..output.progress import progress_bar
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from uplift.common.progress import ProgressCallback
    from uplift.lookup import Cube
    from uplift.report.regression import RebuildDifference


@click.command("check")
@click.argument("files", nargs=-1, required=True, shell_complete=options.complete_cube)
@options.atlas_folders
@click.option("--update", is_flag=True, help="Replace the cubes that differ by the rebuilt ones.")
@options.output_format("table", "json")
@options.quiet
@options.verbose
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

    A cube that cannot be read or rebuilt, or that has another lattice, has failed; the others are still checked. If an
    atlas has changed, its cube has failed: the entries that were added, removed or moved are listed, by ΔE00.
    --update replaces every failed cube that can be rebuilt.

    Atlases are identified by name and content. They are searched for in --atlas-dir, the cube's folder, 'atlases'
    in these, and the shipped atlases.
    """
    enable_jit_cache()
    with progress_bar(quiet=quiet, verbose=verbose) as progress:
        results = [_check(Path(file), folders, progress) for file in dict.fromkeys(files)]
    if style == "json":
        print_json([_object(result) for result in results])
    elif not quiet:
        _print_table(results)
        for result in results:
            _explain(result)
    is_failed = False
    for result in results:
        if result.failures and update and result.rebuilt:
            result.rebuilt.save(result.path, force=True)
            say(f"{result.path}: replaced", err=True)
        elif result.failures:
            is_failed = True
            if result.error and style != "json":
                CommandFailure(result.error).show()
    if is_failed:
        raise SystemExit(1)


@dataclass(frozen=True, eq=False)
class _Result:
    """Result of the check of one cube: a comparison, or the error that prevented it."""

    path: Path
    rebuilt: Cube | None
    comparison: RebuildDifference | None = None
    error: UpliftError | None = None
    changed: tuple[UpliftWarning, ...] = ()

    @property
    def failures(self) -> tuple[str, ...]:
        """Measures over their limits, or the code of the error, and those of changed atlases."""
        changed = tuple(dict.fromkeys(warning.code for warning in self.changed))
        if self.comparison:
            return self.comparison.failures + changed
        return (self.error.code,) if self.error else changed


def _check(path: Path, folders: Sequence[str], progress: ProgressCallback) -> _Result:
    from uplift.lookup import load
    from uplift.pipeline.rebuild import rebuild
    from uplift.report.regression import compare_rebuilt

    rebuilt = None
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", UpliftWarning)
        try:
            stored = load(path)
            rebuilt = rebuild(stored, path, folders, progress=progress)
            changed = tuple(each.message for each in caught if isinstance(each.message, UpliftWarning))
            return _Result(path, rebuilt, compare_rebuilt(path, stored.data, rebuilt.data), changed=changed)
        except UpliftError as error:
            return _Result(path, rebuilt, error=error)


def _explain(result: _Result) -> None:
    """Print what has changed in the atlas of a cube."""
    for warning in result.changed:
        say(f"{result.path}: {warning.problem}")
    for entry in result.comparison.entries if result.comparison else ():
        by = "" if entry.delta_e is None else f", ΔE00 {entry.delta_e:.2g}"
        say(f"  {entry.name}: {entry.change}{by}")


def _object(result: _Result) -> dict[str, object]:
    comparison, error = result.comparison, result.error
    return {
        "cube": str(result.path),
        "passed": not result.failures,
        "failures": list(result.failures),
        "measures": comparison.measures if comparison else {},
        "status": {"stored": comparison.stored_counts, "rebuilt": comparison.rebuilt_counts} if comparison else {},
        "atlas_changed": [warning.problem for warning in result.changed],
        "entries": [asdict(entry) for entry in comparison.entries] if comparison else [],
        "error": error_object(error) if error else None,
    }


def _print_table(results: Sequence[_Result]) -> None:
    from rich.text import Text

    from uplift.report.regression import LIMITS

    headings = {"rgb": "RGB", "spectra_max": "spectra", "spectra_rms": "rms"}
    table = make_table(("cube",), (headings.get(name, name.replace("delta_e_", "ΔE ")) for name in LIMITS))
    for heading in ("nodes", "verdict"):
        table.add_column(heading, no_wrap=True)
    for result in results:
        cells = dict.fromkeys((*LIMITS, "status"), "–")
        if result.comparison:
            cells = {name: f"{result.comparison.measures[name]:.1e}" for name in LIMITS}
            cells["status"] = "differs" if "status" in result.failures else "same"
        styled = (Text(text, style="bold red" if name in result.failures else "") for name, text in cells.items())
        verdict = Text("FAILED", style="bold red") if result.failures else Text("passed", style="green")
        table.add_row(str(result.path), *styled, verdict)
    table.add_row("limit", *(f"{limit:.0e}" for limit in LIMITS.values()), "same", "", style="dim")
    show(table)
