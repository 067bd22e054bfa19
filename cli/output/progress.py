"""Progress on standard error: a bar or a spinner on a terminal; elsewhere, in long commands, a line now and then."""

from __future__ import annotations

import contextlib
import os
import sys
import threading
import time
from collections.abc import Iterator

from uplift.common.progress import Progress, ProgressCallback, ignore_progress

from .console import say

STAGES = {"images": "reading images", "fit": "fitting", "store": "storing"}
"""Descriptions of the stages of a build."""
INTERVAL = 10.0
"""Seconds between lines, and before the first one."""


@contextlib.contextmanager
def build_progress(*, quiet: bool, verbose: bool) -> Iterator[ProgressCallback]:
    """Yield a callback for `uplift.build`: all lines if ``verbose``, none if ``quiet``, otherwise bar or lines."""
    if verbose:
        yield _print_line
    elif quiet:
        yield ignore_progress
    elif not _is_animated():
        yield _Lines()
    else:
        with _build_bar() as progress:
            yield progress


@contextlib.contextmanager
def spinner(text: str) -> Iterator[None]:
    """Show a spinner with ``text``, or a line now and then, while the block runs."""
    if not _is_animated():
        with _clock(text):
            yield
        return
    from rich.console import Console

    with Console(stderr=True).status(f"{text} …"):
        yield


@contextlib.contextmanager
def progress_bar(title: str, *, quiet: bool = False) -> Iterator[ProgressCallback]:
    """Yield a callback that moves a bar titled ``title``; silent if ``quiet``."""
    if quiet or not _is_animated():
        yield ignore_progress if quiet else _Lines(title)
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn
    from rich.progress import Progress as Bar

    columns = (TextColumn(title), BarColumn(bar_width=None), MofNCompleteColumn())
    with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(title, total=None)
        yield lambda event: bar.update(task, completed=event.done, total=event.total)


@contextlib.contextmanager
def stage_spinner() -> Iterator[ProgressCallback]:
    """Yield a callback that shows the current stage with a spinner."""
    if not _is_animated():
        yield _Lines()
        return
    from rich.console import Console

    with Console(stderr=True).status("…") as status:
        yield lambda event: status.update(f"{event.stage} ({event.done + 1} of {event.total}) …")


def _is_animated() -> bool:
    """Return whether standard error is a terminal that can replace a line."""
    return sys.stderr.isatty() and os.environ.get("TERM", "dumb") not in ("dumb", "unknown")


class _Lines:
    """Prints an event when the last line is `INTERVAL` old."""

    def __init__(self, title: str | None = None) -> None:
        self._title, self._last = title, time.monotonic()

    def __call__(self, event: Progress) -> None:
        now = time.monotonic()
        if now - self._last >= INTERVAL:
            self._last = now
            _print_line(event, self._title)


@contextlib.contextmanager
def _clock(text: str) -> Iterator[None]:
    """Print ``text`` and the time passed, every `INTERVAL`, while the block runs."""
    begin, finished = time.monotonic(), threading.Event()

    def tell() -> None:
        while not finished.wait(INTERVAL):
            say(f"{text}: {time.monotonic() - begin:.0f} s", err=True)

    thread = threading.Thread(target=tell, daemon=True)
    thread.start()
    try:
        yield
    finally:
        finished.set()
        thread.join()


def _print_line(event: Progress, title: str | None = None) -> None:
    detail = f", {event.detail}" if event.detail else ""
    name = title or STAGES.get(event.stage, event.stage)
    say(f"{name}: {event.done} of {event.total}{detail}", err=True)


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
