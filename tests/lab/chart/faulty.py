"""Peers of the chart that abort or are not installed. A child process imports
this module.
"""

import os

from uplift.lab.method import Method, NotInstalledError, PreparedMethod

NEEDS = "a library that works: install it"


def abort(task):
    """Prepare a method that aborts its process when it is called."""
    return PreparedMethod(lambda rgb, wavelengths: os.abort(), 8)


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
    for prepare in (abort, lack)
)
