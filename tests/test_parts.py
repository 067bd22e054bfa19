"""Parts of a machine that are missing or broken skip a test, and working ones do not."""

from __future__ import annotations

import os
import subprocess
from functools import partial

import pytest

from tests.parts import Part, need


def test_a_part_that_works_is_used():
    need(Part("a", "install it", partial(abs, -1)))


@pytest.mark.parametrize(
    ("trial", "reason"),
    [
        (os.abort, "crashed: signal 6"),
        (partial(os._exit, 3), "crashed: exit code 3"),
        (partial(subprocess.run, ["no-such-program"], check=True), "No such file or directory"),
    ],
)
@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_a_broken_part_skips_the_test_with_the_reason(trial, reason):
    with pytest.raises(pytest.skip.Exception, match=f"needs a, install it: .*{reason}"):
        need(Part("a", "install it", trial))
