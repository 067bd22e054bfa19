"""Settings of the process that must precede the import of JAX or numpy."""

from __future__ import annotations

import os
import warnings
from pathlib import Path

from uplift.common.errors import UpliftWarning


def draw_without_window() -> None:
    """Use the backend of matplotlib that needs no display."""
    os.environ["MPLBACKEND"] = "agg"


def hide_drawing_notes() -> None:
    """Hide matplotlib's notes on folders and fonts."""
    import logging

    logging.getLogger("matplotlib").addHandler(logging.NullHandler())


def enable_jit_cache() -> None:
    """Keep compiled JAX code in the user's cache folder, so that later commands do not compile it again.

    Warns if other users can write to the folder, which is not used then.
    """
    if "JAX_COMPILATION_CACHE_DIR" in os.environ:
        return
    from platformdirs import user_cache_dir

    from .jit_cache import SharedFolderError, prepare

    try:
        folder = Path(user_cache_dir("uplift"))
    except RuntimeError:  # a user without a home compiles every time
        return
    try:
        if not prepare(folder):
            return
    except SharedFolderError as error:
        problem = f"other users can write to {error}: compiled code is not kept there"
        hint = "remove the folder, or name another one by JAX_COMPILATION_CACHE_DIR"
        warnings.warn(UpliftWarning(problem, code="shared-cache", hint=hint), stacklevel=2)
        return
    os.environ["JAX_COMPILATION_CACHE_DIR"] = str(folder)
    os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS", "0")
    os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_ENTRY_SIZE_BYTES", "-1")


def use_one_blas_thread() -> None:
    """Limit linear algebra of numpy to one thread, for timings."""
    from uplift.lab.timing import ONE_THREAD

    os.environ.update(ONE_THREAD)
