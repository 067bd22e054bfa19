"""Which pictures of several sequences are of one frame or tile."""

import pytest

from tests.helpers import raises
from uplift.common.errors import TextureError
from uplift.extras.images.sequences import pair_frames

ROWS = """
a.*.1.x > b.*.2.x | a.2.1.x a.10.1.x b.02.2.x b.10.2.x | a.10.1.x b.10.2.x
a.*.1.x > b.*.2.x | a.2.1.x a.10.1.x b.02.2.x b.10.2.x | a.2.1.x b.02.2.x
a.<UDIM>.x > b.*.x | a.1001.x a.1002.x b.1002.x b.1001.x | a.1002.x b.1002.x
a.1.x a.2.x > b/v2.????.x | a.1.x a.2.x b/v2.0002.x b/v2.0001.x | a.2.x b/v2.0002.x
a*.x > b*.x | ay.1.x ay.2.x bc.02.x bc.01.x | ay.2.x bc.02.x
a.1*.x > b.[0-9]*.x | a.10.x a.11.x b.11.x b.10.x | a.11.x b.11.x
a/*.x > b/*.x | a/p.x a/q.x b/q.x b/p.x | a/q.x b/q.x
a.x > b*.x | a.x b7.x | a.x b7.x
a8.x > b9.x | a8.x b9.x | a8.x b9.x
a.*.x > b.*.x | a.3.x b.003.x | a.3.x b.003.x
a.*.x > b.*.x | a.1.x a.2.x b.1.x b.3.x | a.*.x lacks 3; b.*.x lacks 2
a.1.x a.2.x > b.*.x | a.1.x a.2.x b.1.x b.3.x | a.1.x, a.2.x lacks 3; b.*.x lacks 2
a.1001.x > b.<UDIM>.x | a.1001.x b.1002.x | a.1001.x lacks 1002
a.*.x > b.*.x | a.1.x b.2.x | a.*.x lacks 2; b.*.x lacks 1
a.*.x > b.*.x | a.1.x b.1.x b.2.x | a.*.x lacks
a.1*.x > b.*.x | a.10.x a.11.x b.0.x b.1.x | a.1*.x lacks 0, 1
a.*.x > b.*.x | a.2.x a.02.x b.2.x b.02.x | b.*.x has one twice
a*.x > b*.x | ap.x aq.x br.x bs.x | a*.x lacks r, s
"""
"""Two sequences | the files that are there | a pair, or what an error states."""


@pytest.mark.parametrize("row", ROWS.strip().splitlines())
def test_pairs(home, row):
    named, files, expected = row.split(" | ")
    (home / "a").mkdir()
    (home / "b").mkdir()
    for file in files.split():
        (home / file).touch()
    sequences = [words.split() for words in named.split(" > ")]
    if "lacks" in expected or "twice" in expected:
        with raises(TextureError, "frames-differ") as caught:
            pair_frames(sequences)
        assert expected in str(caught.value)
        return
    pairs = pair_frames(sequences)
    assert tuple(expected.split()) in pairs
    assert len(pairs) == len(files.split()) / 2
