"""What a process has once: the environment, the working folder and the variant of Mitsuba."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator

LIBRARIES = ("KMP_DUPLICATE_LIB_OK", "KMP_INIT_AT_FORK")
"""Variables that libraries set while they are imported, and need from then on."""


@contextlib.contextmanager
def kept_process_state() -> Iterator[None]:
    """Restore it after the block. A variant of Mitsuba cannot be unset: the first one stays."""
    environment, folder, variant = dict(os.environ), os.getcwd(), _variant()
    try:
        yield
    finally:
        for name in os.environ.keys() - environment.keys() - set(LIBRARIES):
            del os.environ[name]
        os.environ.update(environment)
        os.chdir(folder)
        if variant is not None and variant != _variant():
            sys.modules["mitsuba"].set_variant(variant)


def _variant() -> str | None:
    mitsuba = sys.modules.get("mitsuba")
    return mitsuba.variant() if mitsuba is not None else None
