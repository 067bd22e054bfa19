"""Peers of the chart that abort, hang or are not installed. A child process imports
this module.
"""

import os
import time

from uplift.lab.method import Method, NotInstalledError, PreparedMethod

NEEDS = "a library that works: install it"


def abort(task):
    """Prepare a method that aborts its process when it is called."""
    return PreparedMethod(lambda rgb, wavelengths: os.abort(), 8)


def hang(task):
    time.sleep(3600)


def lack(task):
    raise NotInstalledError(f"needs {NEEDS}")


METHODS = tuple(
    Method(
        method=f"faulty-{prepare.__name__}",
        title="Faulty",
        source="a test",
        prepare=prepare,
        needs=NEEDS,
    )
    for prepare in (abort, hang, lack)
)
