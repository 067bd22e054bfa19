"""What only a whole process may set, before JAX and numpy are imported."""

from __future__ import annotations

import os


def keep_compiled() -> None:
    """Keep what JAX compiles in the user's cache folder, so that the next build starts at once."""
    from platformdirs import user_cache_dir

    os.environ.setdefault("JAX_COMPILATION_CACHE_DIR", user_cache_dir("uplift"))
    os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS", "0")
    os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_ENTRY_SIZE_BYTES", "-1")


def one_thread() -> None:
    """Keep numpy's linear algebra to one thread, for timings; read when numpy is imported."""
    from uplift.lab.timing import ONE_THREAD

    os.environ.update(ONE_THREAD)
