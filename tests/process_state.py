"""What a process has once: the environment, the working folder and the variant of
Mitsuba.
"""

import contextlib
import os
import sys
from collections.abc import Iterator

from uplift.extras.timing import ONE_THREAD

SET_BY_COMMANDS = (*ONE_THREAD, "MPLBACKEND", "PJRT_NPROC")
"""Variables that are removed if they are new. Libraries set others while they are
imported, and need them later.
"""


@contextlib.contextmanager
def kept_process_state() -> Iterator[None]:
    """Restore it after the block. A variant of Mitsuba cannot be unset: the first one
    stays.
    """
    environment = dict(os.environ)
    folder = os.getcwd()
    variant = _variant()
    try:
        yield
    finally:
        for name in set(SET_BY_COMMANDS) - environment.keys():
            os.environ.pop(name, None)
        os.environ.update(environment)
        os.chdir(folder)
        if variant is not None and variant != _variant():
            sys.modules["mitsuba"].set_variant(variant)


def _variant() -> str | None:
    mitsuba = sys.modules.get("mitsuba")
    return mitsuba.variant() if mitsuba is not None else None
