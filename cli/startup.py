"""Settings of the process that must precede the import of JAX or numpy."""

from __future__ import annotations

import os


def draw_without_window() -> None:
    """Use the backend of matplotlib that needs no display; one that the user prefers may not exist."""
    os.environ["MPLBACKEND"] = "agg"


def enable_jit_cache() -> None:
    """Keep compiled JAX code in the user's cache folder, so that later commands do not compile it again."""
    from platformdirs import user_cache_dir

    os.environ.setdefault("JAX_COMPILATION_CACHE_DIR", user_cache_dir("uplift"))
    os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS", "0")
    os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_ENTRY_SIZE_BYTES", "-1")


def use_one_blas_thread() -> None:
    """Limit linear algebra of numpy to one thread, for timings."""
    from uplift.lab.timing import ONE_THREAD

    os.environ.update(ONE_THREAD)
