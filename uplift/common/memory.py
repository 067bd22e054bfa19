"""Memory of the machine."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path

CGROUP_LIMITS = ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes")
"""Limits of a container, by version of cgroups."""


def total_memory() -> int | None:
    """Return the bytes that this process may have at most, None if unknown: of the machine or of its container."""
    limits = []
    with contextlib.suppress(AttributeError, ValueError, OSError):  # not on Windows
        limits.append(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    for path in CGROUP_LIMITS:
        with contextlib.suppress(OSError, ValueError):  # "max" without a limit
            limits.append(int(Path(path).read_text()))
    return min(limits, default=None)
