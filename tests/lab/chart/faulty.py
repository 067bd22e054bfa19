"""Peers of the chart that abort, hang or are not installed. A child process imports this module."""

from __future__ import annotations

import os
import time

from uplift.lab.chart.method import Family, Method, NotInstalledError, PreparedMethod

NEEDS = "a library that works: install it"


def abort(task):
    """Prepare a method that aborts its process when it is called."""
    return PreparedMethod(lambda rgb, wavelengths: os.abort(), 8)


def hang(task):
    time.sleep(3600)


def lack(task):
    raise NotInstalledError(f"needs {NEEDS}")


def leave(task):
    os._exit(3)


FAMILY = Family(
    "Faulty",
    "a test",
    "#000000",
    tuple(
        Method(f"faulty-{prepare.__name__}", f"Faulty, {prepare.__name__}", prepare, needs=NEEDS)
        for prepare in (abort, hang, lack, leave)
    ),
)
