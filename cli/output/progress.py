"""Progress on the terminal: a bar, a spinner, or a line per step; silent elsewhere."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator

from uplift.common.progress import Progress, ProgressCallback, ignore_progress

from ..signals import check
from .console import say

STAGES = {"images": "reading images", "fit": "fitting", "store": "storing"}
"""Descriptions of the stages of a build."""


@contextlib.contextmanager
def build_progress(*, quiet: bool, verbose: bool) -> Iterator[ProgressCallback]:
    """Yield a callback for `uplift.build`: lines if ``verbose``, a bar on a terminal, silent otherwise."""
    if verbose:
        yield _checked(_print_line)
    elif quiet or not sys.stderr.isatty():
        yield _checked(ignore_progress)
    else:
        with _build_bar() as progress:
            yield _checked(progress)
    check()


def _checked(callback: ProgressCallback) -> ProgressCallback:
    """Raise `KeyboardInterrupt` at the next event if a signal has arrived; see `uplift_cli.signals`."""

    def progress(event: Progress) -> None:
        check()
        callback(event)

    return progress


@contextlib.contextmanager
def spinner(text: str) -> Iterator[None]:
    """Show a spinner with ``text`` while the block runs."""
    if not sys.stderr.isatty():
        yield
        return
    from rich.console import Console

    with Console(stderr=True).status(f"{text} …"):
        yield


@contextlib.contextmanager
def progress_bar(title: str) -> Iterator[ProgressCallback]:
    """Yield a callback that moves a bar titled ``title``."""
    if not sys.stderr.isatty():
        yield _checked(ignore_progress)
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn
    from rich.progress import Progress as Bar

    columns = (TextColumn(title), BarColumn(bar_width=None), MofNCompleteColumn())
    with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(title, total=None)
        yield _checked(lambda event: bar.update(task, completed=event.done, total=event.total))


@contextlib.contextmanager
def stage_spinner() -> Iterator[ProgressCallback]:
    """Yield a callback that shows the current stage with a spinner."""
    if not sys.stderr.isatty():
        yield _checked(ignore_progress)
        return
    from rich.console import Console

    with Console(stderr=True).status("…") as status:
        yield _checked(lambda event: status.update(f"{event.stage} ({event.done + 1} of {event.total}) …"))


def _print_line(event: Progress) -> None:
    detail = f", {event.detail}" if event.detail else ""
    say(f"{STAGES[event.stage]}: {event.done} of {event.total}{detail}", err=True)


@contextlib.contextmanager
def _build_bar() -> Iterator[ProgressCallback]:
    """Yield a callback for a bar whose first half is fitting and whose second half is storing."""
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    columns = (
        TextColumn("{task.fields[stage]}"),
        BarColumn(bar_width=None),
        TextColumn("{task.percentage:>3.0f} %"),
        TimeRemainingColumn(),
    )
    with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("build", total=None, stage="fitting the atlas")

        def progress(event: Progress) -> None:
            stage = STAGES[event.stage]
            if event.stage == "images":
                bar.update(task, total=event.total, completed=event.done, stage=stage)
                return
            done = event.done + (event.total if event.stage == "store" else 0)
            bar.update(task, total=2 * event.total, completed=done, stage=stage)

        yield progress
