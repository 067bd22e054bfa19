"""The machine: threads of linear algebra, and memory."""

import contextlib
import os
import re
import threading
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

from uplift.common.errors import OptionError, UpliftError

_LOCK = threading.Lock()
_CALLERS: set[object] = set()
_LIMITS: list[Any] = []
"""Those of the callers in their order, all lifted after the last caller: a later one
may know more libraries.
"""


@contextlib.contextmanager
def single_threaded_blas() -> Iterator[None]:
    """Limit BLAS to one thread, until the last of several concurrent callers is done.

    The matrices of this package are small, so threads would wait for each other.
    Results then also do not depend on the number of threads, which changes the rounding
    of sums. The threads of XLA are not affected: they distribute rows. Only loaded
    libraries are limited: scipy, which brings its own BLAS, must be imported before.
    """
    from threadpoolctl import (
        OpenBLASController,
        ThreadpoolController,
        threadpool_limits,
    )

    per_thread = ThreadpoolController().select(
        threading_layer="openmp"
    )  # its limits hold for the calling thread
    with per_thread.limit(limits=1, user_api="blas"):
        # A limit lifted by one caller would hold no longer for the others, so all are
        # kept until the last has left.
        caller = object()
        with _LOCK:
            _CALLERS.add(caller)
            _LIMITS.append(threadpool_limits(1, user_api="blas"))
        try:
            yield
        finally:
            with _LOCK:
                _CALLERS.remove(caller)
                while _LIMITS and not _CALLERS:
                    # The limit can otherwise be restored by the thread only that set
                    # it.
                    OpenBLASController.clear_controlling_thread(force=True)
                    _LIMITS.pop().restore_original_limits()


AVAILABLE = re.compile(r"^(?:MemAvailable|SwapFree): +(\d+)", re.MULTILINE)
PROCESS_BYTES = 500_000_000
"""Memory of a build without its lattice."""
THREADS = 1_200_000_000
"""Addresses that the threads of XLA reserve, which a limit of addresses must leave."""
CGROUP_LIMITS = (
    "/sys/fs/cgroup/memory.max",
    "/sys/fs/cgroup/memory/memory.limit_in_bytes",
)
"""Limits of a container, by version of cgroups."""


def free_memory() -> int | None:
    """Return the bytes that this process can still have: of the machine, its container,
    its limit; None if unknown.
    """
    limits = []
    with contextlib.suppress(OSError, AttributeError):  # on Linux
        limits.append(
            1024 * sum(map(int, AVAILABLE.findall(Path("/proc/meminfo").read_text())))
        )
    with contextlib.suppress(AttributeError, ValueError, OSError):  # not on Windows
        limits.append(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    # A container has the memory of the machine in sysconf, and its limit in a file.
    for path in CGROUP_LIMITS:
        with contextlib.suppress(OSError, ValueError):  # "max" without a limit
            limits.append(int(Path(path).read_text()))
    with contextlib.suppress(ImportError, OSError):
        import resource

        limit, _ = resource.getrlimit(resource.RLIMIT_AS)
        if limit != resource.RLIM_INFINITY:
            used = (
                int(Path("/proc/self/statm").read_text().split()[0])
                * resource.getpagesize()
            )
            limits.append(max(limit - used - THREADS, 0))
    return min(limits, default=None)


def check_memory(
    need: float, subject: str, error: type[UpliftError], hint: str
) -> None:
    """Raise ``error`` (``out-of-memory``) if the subject needs more bytes than are
    known to be free.
    """
    free = free_memory()
    if free is not None and need > free:
        problem = (
            f"{subject} needs about {need / 1e9:.3g} GB of memory, {free / 1e9:.3g} "
            "GB are free"
        )
        raise error(problem, code="out-of-memory", hint=hint)


def require_xla() -> None:
    """Raise an error where XLA would end the process or hang: `OptionError` without
    memory for its threads, `UpliftError` (``forked-process``) after a fork.

    A fork copies no threads: the child would wait for those of the parent for ever.
    """
    if _process_of_xla() != os.getpid():
        raise UpliftError(
            "JAX must not run in a process that was forked after JAX had run",
            code="forked-process",
            hint='start processes by multiprocessing.get_context("spawn")',
        )


@cache
def _process_of_xla() -> int:
    """Return the number of the process that is the first to use XLA, the parent's
    after a fork.
    """
    check_memory(PROCESS_BYTES, "a fit", OptionError, "use a machine with more memory")
    return os.getpid()
