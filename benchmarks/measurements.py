"""All measured pages, one make target after the other: ``make measurements``.

A step is a make target that renders pages. Steps that were measured at this commit are skipped, so an interrupted run
goes on where it stopped; a step that fails is named at the end and does not stop the others. The output of each step
is stored in out/measurements, with the commit and the duration of the last success.

Examples
--------
    python -m benchmarks.measurements            # what is not measured at this commit
    python -m benchmarks.measurements --list     # the steps, and when each was measured
    python -m benchmarks.measurements chart bench --again
    python -m benchmarks.measurements --minutes 75
"""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import click

from benchmarks.record import ROOT
from uplift.common.files import write_text
from uplift.lab.timing import commit

STEPS = (
    # The most read pages; first those with times, while the machine has nothing else to do.
    *("bench", "chart", "first-steps", "emission", "looks", "prior"),
    *("study", "held-out", "accuracy", "cameras", "environment", "plan", "showcase"),
    # The others, in the same order.
    *(
        "textures",
        "mixing",
        "dial",
        "growth",
        "demo-render",
        "dependencies",
        "display",
        "scenes",
        "look-cubes",
    ),
    *("stability", "hostile", "determinism", "palette", "wavelengths", "representations", "atlas-files"),
)
"""Make targets that measure and render pages, in the order of a run."""
COMPILED_ONCE = frozenset(
    ("study", "held-out", "accuracy", "cameras", "environment", "plan", "showcase", "stability", "palette")
)
"""Steps whose pages have no times of compilation: they share compiled code."""
RENDER = ("docs",)
"""Make target that renders the pages that use figures of other pages."""
FOLDER = ROOT / "out" / "measurements"
CHANGED = "with changes"
"""End of the name of a commit if files of the code differ from it."""


@dataclass(frozen=True)
class Done:
    """The last success of a step: commit, seconds, and local time of its end."""

    commit: str
    seconds: float
    end: str


@dataclass(frozen=True)
class Outcome:
    """Steps of a run that failed, and those that the time did not suffice for."""

    failed: tuple[str, ...] = ()
    left: tuple[str, ...] = ()


@dataclass(frozen=True)
class Journal:
    """A folder with the output of each step, STEP.log, and the successes, done.json."""

    folder: Path

    @property
    def _file(self) -> Path:
        return self.folder / "done.json"

    def read(self) -> dict[str, Done]:
        """Return the last success of each step."""
        if not self._file.is_file():
            return {}
        stored = json.loads(self._file.read_text(encoding="utf-8"))
        return {step: Done(**fields) for step, fields in stored.items()}

    def add(self, step: str, done: Done) -> None:
        """Store the success of a step; the file is replaced as a whole."""
        self.folder.mkdir(parents=True, exist_ok=True)
        content = {name: asdict(each) for name, each in (self.read() | {step: done}).items()}
        write_text(json.dumps(content, indent=1) + "\n", self._file, force=True)

    def log(self, step: str) -> Path:
        """Return the file of the output of a step."""
        self.folder.mkdir(parents=True, exist_ok=True)
        return self.folder / f"{step}.log"


@click.command()
@click.argument("steps", nargs=-1, metavar="[STEP]...")
@click.option("--again", is_flag=True, help="Repeat steps that were measured at this commit.")
@click.option(
    "--minutes",
    type=click.FloatRange(min=0),
    default=math.inf,
    help="Start no step that would end later, by its last duration, than after so many minutes.",
)
@click.option("--list", "listed", is_flag=True, help="List the steps; measure nothing.")
def main(steps: tuple[str, ...], again: bool, minutes: float, listed: bool) -> None:
    """Measure all pages, or those of the given steps."""
    unknown = [step for step in steps if step not in STEPS]
    if unknown:
        raise click.ClickException(f"no step '{unknown[0]}'; steps are {', '.join(STEPS)}")
    chosen, journal, now = [step for step in STEPS if step in steps or not steps], Journal(FOLDER), commit()
    if listed:
        for step in chosen:
            click.echo(describe(step, journal.read().get(step)))
        return
    if now.endswith(CHANGED):
        click.echo("files differ from the commit: pages will state it, and no step is skipped later", err=True)
    commands = {step: ("make", "--no-print-directory", step) for step in (*chosen, *RENDER)}
    due = [step for step in chosen if again or not is_current(journal.read().get(step), now)]
    outcome = run_steps({step: commands[step] for step in due}, journal, now, 60 * minutes)
    outcome = Outcome(outcome.failed + run_steps({s: commands[s] for s in RENDER}, journal, now).failed, outcome.left)
    if outcome.left:
        click.echo(f"no time for {', '.join(outcome.left)}: run again")
    if outcome.failed:
        logs = ", ".join(str(journal.log(step)) for step in outcome.failed)
        raise click.ClickException(
            f"failed: {', '.join(outcome.failed)}; output in {logs}. Run again to repeat only these."
        )
    click.echo("done" if steps or outcome.left else "all pages are measured at one commit")


def is_current(done: Done | None, now: str) -> bool:
    """Whether a step was measured at the commit ``now``; never with changed files."""
    return done is not None and done.commit == now and not now.endswith(CHANGED)


def describe(step: str, done: Done | None) -> str:
    """Return a line about a step."""
    if done is None:
        return f"{step}: not measured"
    return f"{step}: {duration(done.seconds)}, {done.end}, commit {done.commit}"


def duration(seconds: float) -> str:
    """Return a duration in hours, minutes and seconds.

    Examples
    --------
    >>> duration(3723.4)
    '1:02:03'
    """
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes // 60}:{minutes % 60:02}:{rest:02}"


def run_steps(commands: Mapping[str, Sequence[str]], journal: Journal, now: str, seconds: float = math.inf) -> Outcome:
    """Run each command, log its output and duration, and store its success.

    Parameters
    ----------
    commands : mapping of str to sequence of str
        Command of each step, in order.
    journal : Journal
        Where to store outputs and successes.
    now : str
        Commit of the code.
    seconds : float, optional
        Time after which all steps must have ended, if they take as long as they last did.

    Returns
    -------
    Outcome
        Steps that failed, and those that were not started. The others were run nonetheless.
    """
    failed, left, end = [], [], time.perf_counter() + seconds
    for number, (step, command) in enumerate(commands.items(), start=1):
        last = journal.read().get(step)
        if time.perf_counter() + (last.seconds if last else 0.0) > end:
            left.append(step)
            continue
        click.echo(f"[{number}/{len(commands)}] {step}", err=True)
        if not run_step(step, command, journal, now):
            failed.append(step)
    return Outcome(tuple(failed), tuple(left))


def run_step(step: str, command: Sequence[str], journal: Journal, now: str) -> bool:
    """Run a command, log its output and duration, and store its success, which is returned."""
    begin = time.perf_counter()
    with journal.log(step).open("w", encoding="utf-8") as output:
        code = subprocess.run(
            command,
            cwd=ROOT,
            stdout=output,
            stderr=subprocess.STDOUT,
            check=False,
            env=os.environ | (compiled_code(journal.folder) if step in COMPILED_ONCE else {}),
        ).returncode
    seconds = time.perf_counter() - begin
    if code:
        click.echo(f"{step} failed with exit status {code} after {duration(seconds)}", err=True)
        return False
    journal.add(step, Done(now, seconds, time.strftime("%Y-%m-%d %H:%M")))
    click.echo(f"{step}: {duration(seconds)}", err=True)
    return True


def compiled_code(folder: Path) -> dict[str, str]:
    """Return the variables by which JAX keeps compiled code in a folder, however small."""
    return {
        "JAX_COMPILATION_CACHE_DIR": str(folder / "compiled"),
        "JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS": "0",
        "JAX_PERSISTENT_CACHE_MIN_ENTRY_SIZE_BYTES": "-1",
    }


if __name__ == "__main__":
    sys.exit(main())
