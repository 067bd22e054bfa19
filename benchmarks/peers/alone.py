"""Each tool runs in a separate process, without the threads, compiled code or settings of the others."""

from __future__ import annotations

import os
from collections.abc import Callable

from benchmarks.peers.row import Peer
from uplift.common.processes import ChildError, call_in_child
from uplift.lab.timing import ONE_THREAD

LIMIT = 3600
"""Seconds after which a tool counts as hung."""


def alone(tool: Callable[[int], list[Peer]], runs: int, seconds: float = LIMIT) -> list[Peer]:
    """Return the rows of ``tool``, timed ``runs`` times in a fresh process, or one that states how it failed."""
    before = dict(os.environ)
    os.environ.update(ONE_THREAD)
    try:
        return call_in_child(tool, runs, seconds=seconds)
    except ChildError as error:
        return [Peer(tool.__name__, "", 0, 0, None, None, str(error))]
    finally:
        os.environ.clear()
        os.environ.update(before)
