"""Progress bars, of a build or of any counted work, a spinner over other waits: on a terminal, and nowhere else."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from uplift.fit import Round

Watch = Callable[["Round"], None]


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


def _say(done: Round) -> None:
    click.echo(f"round {done.number}: tried {done.tried}, fitted {done.fitted} of {done.total}", err=True)


@contextlib.contextmanager
def _bar() -> Iterator[Watch]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("round {task.fields[round]:>3}"),
        BarColumn(bar_width=None),
        MofNCompleteColumn(),
        TextColumn("{task.fields[rate]}"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("fit", total=None, round=0, rate="")

        def watch(done: Round) -> None:
            elapsed = progress.tasks[task].elapsed or 0.0
            rate = f"{done.fitted / elapsed:,.0f} points/s" if elapsed > 0 else ""
            progress.update(task, total=done.total, completed=done.fitted, round=done.number, rate=rate)

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
