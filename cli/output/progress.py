"""Progress bars, of a build or of any counted work, a spinner over other waits: on a terminal, and nowhere else."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from uplift.fit import Round, Storing
    from uplift.io.scene_colours import ReadProgress
    from uplift.pipeline.build_cube import Watch
    from uplift.scene.plan import Step


@contextlib.contextmanager
def watching(*, quiet: bool, verbose: bool) -> Iterator[Watch]:
    """A watcher for `uplift.build`: silent, a line a round, or a bar, as asked for and as the terminal allows."""
    if verbose:
        yield _say
    elif quiet or not sys.stderr.isatty():
        yield lambda done: None
    else:
        with _bar() as watch:
            yield watch


@contextlib.contextmanager
def waiting(text: str) -> Iterator[None]:
    """A line that says what takes so long."""
    if not sys.stderr.isatty():
        yield
        return
    from rich.console import Console

    with Console(stderr=True).status(f"{text} …"):
        yield


def _say(done: Round | Storing | ReadProgress) -> None:
    click.echo(_told(done), err=True)


def _told(done: Round | Storing | ReadProgress) -> str:
    from uplift.fit import Storing
    from uplift.io.scene_colours import ReadProgress

    if isinstance(done, ReadProgress):
        return f"scene: read {done.read} of {done.total} images"
    if isinstance(done, Storing):
        return f"stored {done.stored} of {done.total}"
    return f"round {done.number}: tried {done.tried}, fitted {done.fitted} of {done.total}"


@contextlib.contextmanager
def _bar() -> Iterator[Watch]:
    """A bar over a build: fitting fills the first half, storing, which takes as long, the second."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.fields[told]}"),
        BarColumn(bar_width=None),
        TextColumn("{task.percentage:>3.0f} %"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("build", total=None, told="atlas")

        def watch(done: Round | Storing | ReadProgress) -> None:
            from uplift.fit import Storing
            from uplift.io.scene_colours import ReadProgress

            if isinstance(done, ReadProgress):
                progress.update(task, total=done.total, completed=done.read, told=_told(done))
                return
            reached = done.total + done.stored if isinstance(done, Storing) else done.fitted
            progress.update(task, total=2 * done.total, completed=reached, told=_told(done))

        yield watch


@contextlib.contextmanager
def counting(what: str) -> Iterator[Callable[[int, int], None]]:
    """A watcher that is told how many of how many are done: a bar on a terminal, silent elsewhere."""
    if not sys.stderr.isatty():
        yield lambda done, total: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    columns = (TextColumn(what), BarColumn(bar_width=None), MofNCompleteColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task(what, total=None)
        yield lambda done, total: progress.update(task, completed=done, total=total)


@contextlib.contextmanager
def stepping() -> Iterator[Callable[[Step], None]]:
    """A watcher of a plan: a spinner that says what is measured, on a terminal."""
    if not sys.stderr.isatty():
        yield lambda step: None
        return
    from rich.console import Console

    with Console(stderr=True).status("…") as status:
        yield lambda step: status.update(f"{step.what} ({step.done + 1} of {step.total}) …")
