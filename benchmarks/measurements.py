"""All measured pages, one make target after the other: ``make measurements``.

A step is a make target that renders pages. Steps that were measured at this commit are skipped, so an interrupted run
goes on where it stopped; a step that fails is named at the end and does not stop the others. The output of each step
is stored in out/measurements, with the commit and the duration of the last success.

Examples
--------
    python -m benchmarks.measurements            # what is not measured at this commit
    python -m benchmarks.measurements --list     # the steps, and when each was measured
    python -m benchmarks.measurements chart bench --again
"""

from __future__ import annotations

import json
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
    # Times of few milliseconds first, while the machine has nothing else to do.
    *("bench", "chart", "first-steps", "dependencies", "growth", "mixing", "dial", "textures", "demo-render"),
    # Accuracy, which other processes do not change.
    *(
        "accuracy",
        "study",
        "prior",
        "held-out",
        "cameras",
        "display",
        "scenes",
        "plan",
        "palette",
        "look-cubes",
        "wavelengths",
        "looks",
        "emission",
        "environment",
    ),
    *("representations", "atlas-files", "showcase", "determinism", "stability", "nightly"),
)
"""Make targets that measure and render pages, in the order of a run."""
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
        content = {name: asdict(each) for name, each in (self.read() | {step: done}).items()}
        write_text(json.dumps(content, indent=1) + "\n", self._file, force=True)

    def log(self, step: str) -> Path:
        """Return the file of the output of a step."""
        self.folder.mkdir(parents=True, exist_ok=True)
        return self.folder / f"{step}.log"


@click.command()
@click.argument("steps", nargs=-1, metavar="[STEP]...")
@click.option("--again", is_flag=True, help="Repeat steps that were measured at this commit.")
@click.option("--list", "listed", is_flag=True, help="List the steps; measure nothing.")
def main(steps: tuple[str, ...], again: bool, listed: bool) -> None:
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
        click.echo(
            "files differ from the commit: pages will state it, and no step is skipped later", err=True
        )
    commands = {step: ("make", "--no-print-directory", step) for step in (*chosen, *RENDER)}
    due = [step for step in chosen if again or not is_current(journal.read().get(step), now)]
    failed = run_steps({step: commands[step] for step in (*due, *RENDER)}, journal, now)
    if failed:
        logs = ", ".join(str(journal.log(step)) for step in failed)
        raise click.ClickException(
            f"failed: {', '.join(failed)}; output in {logs}. Run again to repeat only these."
        )
    click.echo("all pages are measured at one commit" if not steps else "done")


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


def run_steps(commands: Mapping[str, Sequence[str]], journal: Journal, now: str) -> list[str]:
    """Run each command, log its output and duration, and store its success.

    Parameters
    ----------
    commands : mapping of str to sequence of str
        Command of each step, in order.
    journal : Journal
        Where to store outputs and successes.
    now : str
        Commit of the code.

    Returns
    -------
    list of str
        Steps that failed; the others were run nonetheless.
    """
    failed = []
    for number, (step, command) in enumerate(commands.items(), start=1):
        click.echo(f"[{number}/{len(commands)}] {step}", err=True)
        begin = time.perf_counter()
        with journal.log(step).open("w", encoding="utf-8") as output:
            code = subprocess.run(
                command, cwd=ROOT, stdout=output, stderr=subprocess.STDOUT, check=False
            ).returncode
        seconds = time.perf_counter() - begin
        if code:
            failed.append(step)
            click.echo(f"{step} failed with exit status {code} after {duration(seconds)}", err=True)
            continue
        journal.add(step, Done(now, seconds, time.strftime("%Y-%m-%d %H:%M")))
        click.echo(f"{step}: {duration(seconds)}", err=True)
    return failed


if __name__ == "__main__":
    sys.exit(main())
