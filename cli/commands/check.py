"""``uplift check``: compare cubes with rebuilt ones, and renderers with cubes."""

from __future__ import annotations

import warnings
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.colorimetry.illuminants import Illuminant
from uplift.common.errors import UpliftError, UpliftWarning

from .. import conformance, option_types, options
from ..output.console import make_table, paragraph, print_json, say, show
from ..output.diagnostics import BAD_INPUT, FAILED_CHECK, CommandFailure, error_object
from ..output.progress import progress_bar
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from rich.text import Text

    from uplift.common.progress import ProgressCallback
    from uplift.lookup.cube import Cube

REBUILDING = ("files", "folders", "update", "style", "quiet")
"""Parameters that apply to cubes which are rebuilt."""
APPLICABLE = {
    "kit": ("files", "force"),
    "renderer": ("files", "light", "style", "plot_path", "force"),
}
"""Parameters that apply to other purposes."""
NEEDS = {
    "light": "needs --renderer",
    "plot_path": "needs --renderer",
    "force": "needs --kit or --plot",
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
    shell_complete=options.complete_cube,
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
    shell_complete=options.complete_light,
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
    force: bool,
    **rebuilding: Any,
) -> None:
    _check_combination(files)
    enable_jit_cache()
    cube = files[0] if files else None
    if kit is not None:
        conformance.write(cube, kit, force=force)
    elif renderer is not None:
        style = rebuilding["style"]
        conformance.judge(cube, renderer, light, style, plot_path, force=force)
    else:
        _rebuild_all(files, **rebuilding)


def _check_combination(files: Sequence[str]) -> None:
    """Raise a usage error for arguments that do not go together."""
    given = options.given()
    purpose = next((name for name in APPLICABLE if name in given), "")
    applicable = APPLICABLE.get(purpose, REBUILDING)
    for name, option in given.items():
        if name not in (purpose, *applicable):
            apart = f"does not go with --{purpose}" if purpose else NEEDS[name]
            raise click.UsageError(f"{option} {apart}.")
    if purpose and len(files) > 1:
        raise click.UsageError(f"--{purpose} takes one cube.")
    if not purpose and not files:
        raise click.UsageError("Give cubes, --kit or --renderer.")


def _rebuild_all(
    files: Sequence[str],
    folders: Sequence[str],
    update: bool,
    style: str,
    quiet: bool,
) -> None:
    with progress_bar(quiet=quiet) as progress:
        results = [
            _check(Path(file), folders, progress) for file in dict.fromkeys(files)
        ]
    records = [record for record, _, _ in results]
    if style == "json":
        print_json(records)
    elif not quiet:
        _print_table(records)
    code = 0
    for result in results:
        code = max(code, _settle(*result, update=update, is_shown=style != "json"))
    if code:
        raise SystemExit(code)


def _settle(
    record: dict[str, Any],
    rebuilt: Cube | None,
    error: UpliftError | None,
    *,
    update: bool,
    is_shown: bool,
) -> int:
    """Replace a failed cube or show its error, and return the exit code."""
    is_failed = not record["passed"]
    if is_failed and update and rebuilt:
        rebuilt.save(record["cube"], force=True)
        say(f"{record['cube']}: replaced", err=True)
        is_failed = False
    elif error and is_shown:
        CommandFailure(error).show()
    if error:
        return BAD_INPUT
    return FAILED_CHECK if is_failed else 0


def _check(
    path: Path, folders: Sequence[str], progress: ProgressCallback
) -> tuple[dict[str, Any], Cube | None, UpliftError | None]:
    """Return the record of a check, the rebuilt cube if there is one, and the error
    that prevented the comparison.
    """
    from uplift.extras.report.rebuild import rebuild
    from uplift.extras.report.regression import compare_rebuilt
    from uplift.lookup.cube import load

    rebuilt = comparison = error = None
    notes: list[UpliftWarning] = []
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", UpliftWarning)
        try:
            stored = load(path)
            rebuilt = rebuild(stored, path, folders, progress=progress)
            messages = [warning.message for warning in caught]
            notes = [note for note in messages if isinstance(note, UpliftWarning)]
            comparison = compare_rebuilt(path, stored.data, rebuilt.data)
        except UpliftError as cause:
            error = cause
    failures = list(comparison.failures) if comparison else []
    problems = defaultdict(list)
    for note in notes:
        problems[note.code == "atlas-changed"].append(note.problem)
    changed = problems[True]
    if comparison and not failures:
        problems[False] += [f"{text}: same spectra, other bytes" for text in changed]
        changed = []
    if error:
        failures.append(error.code)
    elif changed:
        failures.append("atlas-changed")
    record = {
        "cube": str(path),
        "passed": not failures,
        "failures": failures,
        "measures": {},
        "status": {},
        "atlas_changed": changed,
        "notes": problems[False],
        "entries": [],
        "error": error_object(error) if error else None,
    }
    if comparison:
        record["measures"] = comparison.measures
        record["status"] = {
            "stored": comparison.stored_counts,
            "rebuilt": comparison.rebuilt_counts,
        }
        record["entries"] = list(map(asdict, comparison.entries))
    return record, rebuilt, error


def _short(value: float) -> str:
    """Format a number with one digit and a short exponent."""
    return f"{value:.0e}".replace("e-0", "e-") if value else "0"


def _print_table(records: Sequence[dict[str, Any]]) -> None:
    from uplift.extras.report.regression import LIMITS

    headings = {
        "rgb": "RGB",
        "spectra_max": "spectra",
        "spectra_rms": "rms",
        "delta_e_D65": "ΔE D65",
    }
    measures = [headings.get(name, name.removeprefix("delta_e_")) for name in LIMITS]
    table = make_table(("cube", "result", "atlas", "nodes"), measures)
    for record in records:
        table.add_row(record["cube"], *_cells(record, LIMITS))
    limits = map(_short, LIMITS.values())
    table.add_row("limit", "", "same", "same", *limits, style="dim")
    show(table)
    for record in records:
        for problem in (*record["atlas_changed"], *record["notes"]):
            paragraph(f"{record['cube']}: {problem}")
        for entry in record["entries"]:
            by = "" if entry["delta_e"] is None else f", ΔE00 {entry['delta_e']:.2g}"
            say(f"  {entry['name']}: {entry['change']}{by}")


def _cells(record: dict[str, Any], measures: Iterable[str]) -> Iterator[Text]:
    """Yield the verdict, and every comparison, red where it failed."""
    from rich.text import Text

    if record["passed"]:
        yield Text("passed", style="green")
    else:
        yield Text("FAILED", style="bold red")
    texts = dict.fromkeys(("atlas-changed", "status", *measures), "–")
    failed = dict.fromkeys(record["failures"], "bold red")
    if record["measures"]:
        texts["atlas-changed"] = "changed" if "atlas-changed" in failed else "same"
        texts["status"] = "differs" if "status" in failed else "same"
        for name in measures:
            texts[name] = _short(record["measures"][name])
    for name, text in texts.items():
        yield Text(text, style=failed.get(name, ""))
