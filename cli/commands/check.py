"""``uplift check``: compare stored cubes with rebuilt ones, for continuous
integration.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.common.errors import UpliftError, UpliftWarning

from .. import options
from ..output.console import make_table, paragraph, print_json, say, show
from ..output.diagnostics import BAD_INPUT, FAILED_CHECK, CommandFailure, error_object
from ..output.progress import progress_bar
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from uplift.common.progress import ProgressCallback
    from uplift.extras.report.regression import RebuildDifference
    from uplift.lookup import Cube


@click.command(
    "check",
    help="""Rebuild stored cubes from their recorded options and compare the results.

    \b
    Examples:
      uplift check macbeth-32.uplift
      uplift check macbeth-32.uplift --atlas-dir . --format json
      uplift check macbeth-32.uplift --update

    The comparison covers lattice RGB, spectra (largest and rms difference), ΔE00 under
    D65, A and FL11, and the number of nodes by status. The exit code is 0 if all
    differences are within their limits and 1 otherwise.

    A cube that cannot be read or rebuilt, or that has another lattice, has failed; the
    others are still checked. If an atlas has changed, its cube has failed: the entries
    that were added, removed or moved are listed, by ΔE00. --update replaces every
    failed cube that can be rebuilt.

    The first atlas of the recorded name counts, in --atlas-dir, in the cube's folder,
    and in 'atlases' in these. A shipped atlas replaces it only where there is none and
    the contents are equal. A note names the version that wrote a cube, if it is older
    than this one.
    """,
)
@click.argument(
    "files",
    metavar="CUBE...",
    nargs=-1,
    required=True,
    shell_complete=options.complete_cube,
)
@options.atlas_folders
@click.option(
    "--update", is_flag=True, help="Replace the cubes that differ by the rebuilt ones."
)
@options.output_format("table", "json")
@options.quiet
@options.verbose
def command(
    files: tuple[str, ...],
    folders: tuple[str, ...],
    update: bool,
    style: str,
    quiet: bool,
    verbose: bool,
) -> None:
    enable_jit_cache()
    with progress_bar(quiet=quiet, verbose=verbose) as progress:
        results = [
            _check(Path(file), folders, progress) for file in dict.fromkeys(files)
        ]
    records = [result.record() for result in results]
    if style == "json":
        print_json(records)
    elif not quiet:
        _print_table(records)
    kept = 0
    for result in results:
        if result.failures and update and result.rebuilt:
            result.rebuilt.save(result.path, force=True)
            say(f"{result.path}: replaced", err=True)
        elif result.failures:
            kept += 1
            if result.error and style != "json":
                CommandFailure(result.error).show()
    if any(result.error for result in results):
        raise SystemExit(BAD_INPUT)
    if kept:
        raise SystemExit(FAILED_CHECK)


@dataclass
class Result:
    """A check of a cube: what could be done of it before an error."""

    path: Path
    rebuilt: Cube | None = None
    comparison: RebuildDifference | None = None
    error: UpliftError | None = None
    noted: Sequence[UpliftWarning] = ()

    @property
    def changed(self) -> list[str]:
        """Notes of atlases that have changed."""
        return [note.problem for note in self.noted if note.code == "atlas-changed"]

    @property
    def failures(self) -> list[str]:
        """Names of the measures and codes of the errors that failed."""
        failures = list(self.comparison.failures) if self.comparison else []
        if self.error:
            return [*failures, self.error.code]
        return [*failures, "atlas-changed"] if self.changed else failures

    def record(self) -> dict[str, Any]:
        """Describe the check in JSON values."""
        notes = [note.problem for note in self.noted if note.code != "atlas-changed"]
        record = {
            "cube": str(self.path),
            "passed": not self.failures,
            "failures": self.failures,
            "measures": {},
            "status": {},
            "atlas_changed": self.changed,
            "notes": notes,
            "entries": [],
            "error": error_object(self.error) if self.error else None,
        }
        if self.comparison:
            record["measures"] = self.comparison.measures
            record["status"] = {
                "stored": self.comparison.stored_counts,
                "rebuilt": self.comparison.rebuilt_counts,
            }
            record["entries"] = [asdict(entry) for entry in self.comparison.entries]
        return record


def _check(path: Path, folders: Sequence[str], progress: ProgressCallback) -> Result:
    """Rebuild a cube and compare."""
    from uplift.extras.report.rebuild import rebuild
    from uplift.extras.report.regression import compare_rebuilt
    from uplift.lookup import load

    result = Result(path)
    try:
        stored = load(path)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", UpliftWarning)
            result.rebuilt = rebuild(stored, path, folders, progress=progress)
        messages = [warning.message for warning in caught]
        result.noted = [note for note in messages if isinstance(note, UpliftWarning)]
        result.comparison = compare_rebuilt(path, stored.data, result.rebuilt.data)
    except UpliftError as error:
        result.error = error
    return result


def _short(value: float) -> str:
    """Format a number with one digit and a short exponent."""
    return f"{value:.0e}".replace("e-0", "e-") if value else "0"


def _print_table(records: Sequence[dict[str, Any]]) -> None:
    from rich.text import Text

    from uplift.extras.report.regression import LIMITS

    headings = {
        "rgb": "RGB",
        "spectra_max": "spectra",
        "spectra_rms": "rms",
        "delta_e_D65": "ΔE D65",
    }
    measures = [headings.get(name, name.removeprefix("delta_e_")) for name in LIMITS]
    table = make_table(("cube", "result", "atlas", "nodes"), measures)
    passed = Text("passed", style="green")
    failed = Text("FAILED", style="bold red")
    for record in records:
        failures = record["failures"]
        cells = dict.fromkeys(("atlas-changed", "status", *LIMITS), "–")
        if record["measures"]:
            cells |= {"atlas-changed": "same", "status": "same"}
            cells |= {name: _short(record["measures"][name]) for name in LIMITS}
            differing = {"atlas-changed": "changed", "status": "differs"}
            cells |= {name: differing[name] for name in differing if name in failures}
        styled = [
            Text(text, style="bold red" if name in failures else "")
            for name, text in cells.items()
        ]
        verdict = passed if record["passed"] else failed
        table.add_row(record["cube"], verdict, *styled)
    limits = map(_short, LIMITS.values())
    table.add_row("limit", "", "same", "same", *limits, style="dim")
    show(table)
    _print_changes(records)


def _print_changes(records: Sequence[dict[str, Any]]) -> None:
    for record in records:
        for problem in (*record["atlas_changed"], *record["notes"]):
            paragraph(f"{record['cube']}: {problem}")
        for entry in record["entries"]:
            by = "" if entry["delta_e"] is None else f", ΔE00 {entry['delta_e']:.2g}"
            say(f"  {entry['name']}: {entry['change']}{by}")
