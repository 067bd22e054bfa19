"""Progress on standard error: a bar on a terminal; elsewhere, in long commands, a line
now and then.
"""

import contextlib
import os
import sys
import time
from collections.abc import Iterator

from uplift.common.progress import Progress, ProgressCallback, ignore_progress

from .console import say

STAGES = {"images": "reading images", "fit": "fitting", "store": "storing"}
"""Descriptions of the stages of a build."""
INTERVAL = 10.0
"""Seconds between lines, and before the first one."""


@contextlib.contextmanager
def progress_bar(title: str = "", *, quiet: bool = False) -> Iterator[ProgressCallback]:
    """Yield a callback for events, titled ``title`` or by their stages, which prints
    nothing if ``quiet``.
    """

    def describe(event: Progress) -> str:
        return title or STAGES.get(event.stage, event.stage)

    last = time.monotonic()

    def print_sometimes(event: Progress) -> None:
        nonlocal last
        if time.monotonic() - last >= INTERVAL:
            last = time.monotonic()
            detail = f", {event.detail}" if event.detail else ""
            say(f"{describe(event)}: {event.done} of {event.total}{detail}", err=True)

    is_animated = sys.stderr.isatty() and os.environ.get("TERM", "dumb") not in (
        "dumb",
        "unknown",
    )
    if quiet or not is_animated:
        yield ignore_progress if quiet else print_sometimes
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        TaskProgressColumn,
        TextColumn,
        TimeElapsedColumn,
    )
    from rich.progress import Progress as Bar

    columns = (
        TextColumn("{task.description}"),
        BarColumn(bar_width=None),
        TaskProgressColumn(),
        TimeElapsedColumn(),
    )
    with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(title or "preparing", total=None)
        yield lambda event: bar.update(
            task, description=describe(event), completed=event.done, total=event.total
        )
