"""Public names stay: docs/project/compatibility.md promises a release of warning before
one goes.
"""

import functools

from tools import public_names

stored = functools.cache(public_names.stored_names)
current = functools.cache(public_names.public_names)


def test_no_public_name_has_gone():
    gone = sorted(set(stored()) - set(current()))
    assert gone == [], "restore the names, or follow docs/project/compatibility.md"


def test_every_public_name_is_stored():
    new = sorted(set(current()) - set(stored()))
    assert new == [], "run 'make names'"
