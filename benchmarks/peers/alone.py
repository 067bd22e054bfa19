"""Each tool runs in a separate process, without the threads, compiled code or settings of the others."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor

from benchmarks.peers.row import Peer
from uplift.lab.timing import ONE_THREAD


def alone(tool: Callable[[int], list[Peer]], runs: int) -> list[Peer]:
    """Return the rows of ``tool``, timed ``runs`` times in a fresh process."""
    before = dict(os.environ)
    os.environ.update(ONE_THREAD)
    try:
        with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
            return pool.submit(tool, runs).result()
    finally:
        os.environ.clear()
        os.environ.update(before)
