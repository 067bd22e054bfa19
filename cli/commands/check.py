"""``uplift check``: compare cubes with rebuilt ones, and renderers with cubes."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.colorimetry.illuminants import Illuminant
from uplift.common.errors import UpliftError, UpliftWarning

from .. import conformance, option_types, options
from ..output.console import paragraph, say
from ..output.diagnostics import BAD_INPUT, FAILED_CHECK, CommandFailure, error_object
from ..output.progress import progress_bar
from ..output.table import Format, Table, print_result
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from rich.text import Text

    from uplift.common.progress import ProgressCallback
    from uplift.lookup.cube import Cube

REBUILDING = ("folders", "update", "quiet")
"""Parameters that apply to cubes which are rebuilt."""
NEEDS = {
    "light": "--renderer",
    "plot_path": "--renderer",
    "force": "--kit or --plot",
}
HEADINGS = {
    "cube": "cube",
    "result": "result",
    "changed": "changed",
    "rgb": "RGB",
    "spectra_max": "spectra",
    "spectra_rms": "rms",
    "delta_e": "ΔE00",
}


@click.command(
    "check",
    help="""Rebuild stored cubes from their recorded options and compare the results, or
    test a renderer with --kit and --renderer.

    \b
    Examples:
      uplift check macbeth-32.uplift
      uplift check macbeth-32.uplift --atlas-dir . --format json
      uplift check macbeth-32.uplift --update
      uplift check --kit conformance
      uplift check --renderer conformance/reference-A.exr

    The comparison covers lattice RGB, spectra (largest and rms difference), ΔE00 under
    D65, A and FL11, and the number of nodes by status. The exit code is 0 if all
    differences are within their limits and 1 otherwise.

    A cube that cannot be read or rebuilt, or that has another lattice, has failed; the
    others are still checked. If the spectra of an atlas have changed, its cube has
    failed: the entries that were added, removed or moved are listed, by ΔE00. --update
    replaces every failed cube that can be rebuilt.

    The first atlas of the recorded name counts, in --atlas-dir, in the cube's folder,
    and in 'atlases' in these. A shipped atlas replaces it only where there is none and
    the contents are equal. A note names the version that wrote a cube, if it is older
    than this one.

    --kit writes a cube, a chart of 1,000 colours, their spectra, and scenes of Mitsuba
    and pbrt. --renderer compares what a renderer makes of them, a picture (.exr) or
    spectra (CSV), by ΔE00. CUBE is then the one of the kit, by default the ColorChecker
    in few nodes.
    """,
)
@click.argument(
    "files",
    metavar="[CUBE]...",
    nargs=-1,
    type=options.CUBE,
)
@options.atlas_folders
@options.flag("--update", help="Replace the cubes that differ by the rebuilt ones.")
@click.option(
    "--kit",
    metavar="FOLDER",
    type=option_types.OUTPUT,
    help="Write the conformance kit of a cube to a folder.",
)
@click.option(
    "--renderer",
    metavar="FILE",
    help="Picture (.exr) or spectra (CSV) of the kit by another program.",
)
@click.option(
    "--light",
    metavar="NAME|FILE",
    type=options.LIGHT,
    default="A",
    help="Light of the picture, or for ΔE00 of spectra.",
)
@options.plot("Draw the picture, the one expected, and ΔE00")
@options.table_or_json
@options.quiet
@options.force
def command(
    files: Sequence[str],
    kit: str | None,
    renderer: str | None,
    light: Illuminant,
    plot_path: str | None,
    style: str,
    force: bool,
    **rebuilding: Any,
) -> None:
    purpose = None
    if kit is not None:
        purpose = "--kit"
        options.exclude(purpose, *REBUILDING, "renderer", "light", "plot_path", "style")
    elif renderer is not None:
        purpose = "--renderer"
        options.exclude(purpose, *REBUILDING)
    if purpose and len(files) > 1:
        raise click.UsageError(f"{purpose} takes one cube.")
    enable_jit_cache()
    cube = files[0] if files else None
    if kit is not None:
        conformance.write(cube, kit, force=force)
    elif renderer is not None:
        conformance.judge(cube, renderer, light, style, plot_path, force=force)
    else:
        given = options.given()
        for name, needed in NEEDS.items():
            if name in given:
                raise click.UsageError(f"{given[name]} needs {needed}.")
        if not files:
            raise click.UsageError("Give cubes, --kit or --renderer.")
        _rebuild_all(files, style, **rebuilding)


@dataclass(frozen=True)
class _Check:
    """The record of a check, the rebuilt cube if there is one, and the error that
    prevented the comparison.
    """

    record: dict[str, Any]
    rebuilt: Cube | None
    error: UpliftError | None

    def settle(self, *, update: bool, is_shown: bool) -> int:
        """Replace a failed cube or show its error, and return the exit code."""
        is_failed = not self.record["passed"]
        if is_failed and update and self.rebuilt:
            self.rebuilt.save(self.record["cube"], force=True)
            say(f"{self.record['cube']}: replaced", err=True)
            is_failed = False
        elif self.error and is_shown:
            CommandFailure(self.error).show()
        if self.error:
            return BAD_INPUT
        return FAILED_CHECK if is_failed else 0


def _rebuild_all(
    files: Sequence[str],
    style: str,
    folders: Sequence[str],
    update: bool,
    quiet: bool,
) -> None:
    with progress_bar(quiet=quiet) as progress:
        checks = [_check(file, folders, progress) for file in dict.fromkeys(files)]
    records = [check.record for check in checks]
    if style == "json" or not quiet:
        print_result(style, records, _table(records))
    if style != "json" and not quiet:
        for record in records:
            _print_changes(record)
    codes = [check.settle(update=update, is_shown=style != "json") for check in checks]
    if any(codes):
        raise SystemExit(max(codes))


def _check(file: str, folders: Sequence[str], progress: ProgressCallback) -> _Check:
    """Rebuild a cube and compare the two."""
    from uplift.extras.report.rebuild import rebuild
    from uplift.extras.report.regression import RebuildDifference, compare_rebuilt
    from uplift.lookup.cube import load

    rebuilt = comparison = error = None
    notes: list[UpliftWarning] = []
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", UpliftWarning)
        try:
            stored = load(file)
            rebuilt = rebuild(stored, file, folders, progress=progress)
            messages = [warning.message for warning in caught]
            notes = [note for note in messages if isinstance(note, UpliftWarning)]
            comparison = compare_rebuilt(Path(file), stored.data, rebuilt.data)
        except UpliftError as cause:
            error = cause
    found = comparison or RebuildDifference()
    failures = found.failures
    changed = [note.problem for note in notes if note.code == "atlas-changed"]
    others = [note.problem for note in notes if note.code != "atlas-changed"]
    if comparison and not failures:
        others += [f"{text}: same spectra, other bytes" for text in changed]
        changed = []
    if error:
        failures.append(error.code)
    elif changed:
        failures.append("atlas-changed")
    record = {
        "cube": str(Path(file)),
        "passed": not failures,
        "failures": failures,
        "measures": found.measures,
        "status": found.status,
        "atlas_changed": changed,
        "notes": others,
        "entries": list(map(asdict, found.entries)),
        "error": error_object(error) if error else None,
    }
    return _Check(record, rebuilt, error)


def _table(records: Sequence[dict[str, Any]]) -> Table:
    """The verdicts and every comparison, red where it failed."""
    from uplift.extras.colour.light_sets import REGRESSION_LIGHTS
    from uplift.extras.report.regression import LIMITS

    of_lights = [f"delta_e_{name}" for name in REGRESSION_LIGHTS]
    rows = []
    for record in records:
        failures = record["failures"]
        measures = record["measures"]
        row = dict.fromkeys(HEADINGS) | measures
        row["cube"] = record["cube"]
        row["result"] = "passed" if record["passed"] else "FAILED"
        if measures:
            row["delta_e"] = max(measures[name] for name in of_lights)
            changed = ["atlas"] * ("atlas-changed" in failures)
            row["changed"] = ", ".join(changed + ["nodes"] * ("status" in failures))
        rows.append(row)
    limits = LIMITS | {"delta_e": max(LIMITS[name] for name in of_lights)}
    same = {"cube": "limit", "result": "", "changed": ""}
    formats: dict[str, Format] = {"result": _coloured, "changed": _coloured}
    formats |= {name: partial(_graded, limit) for name, limit in limits.items()}
    return Table([*rows, same | limits], HEADINGS, formats=formats)


def _graded(limit: float, value: float) -> Text:
    """Format a number with one digit and a short exponent."""
    from rich.text import Text

    text = f"{value:.0e}".replace("e-0", "e-") if value else "0"
    return Text(text, style="" if value <= limit else "bold red")


def _coloured(verdict: str) -> Text:
    from rich.text import Text

    return Text(verdict, style="green" if verdict == "passed" else "bold red")


def _print_changes(record: dict[str, Any]) -> None:
    for problem in (*record["atlas_changed"], *record["notes"]):
        paragraph(f"{record['cube']}: {problem}")
    for entry in record["entries"]:
        by = "" if entry["delta_e"] is None else f", ΔE00 {entry['delta_e']:.2g}"
        say(f"  {entry['name']}: {entry['change']}{by}")
