"""Which pictures of several sequences are of one frame or tile."""

from pathlib import Path

import pytest
from uplift_cli.sequences import pair_frames

from tests.helpers import raises
from uplift.common.errors import TextureError


def paired(home: Path, *lines: str) -> list[tuple[str, ...]]:
    """Pair sequences: a pattern or a list of files, and the files that are there."""
    sequences = []
    for line in lines:
        named, _, files = line.partition(" | ")
        for file in (files or named).split():
            path = home / file
            path.parent.mkdir(exist_ok=True)
            path.touch()
        sequences.append(named.split())
    return pair_frames(sequences)


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        (("a.*.1.x | a.2.1.x a.10.1.x", "b.*.2.x | b.02.2.x b.10.2.x"), "2.1 10.1"),
        (("a.<UDIM>.x | a.1001.x a.1002.x", "b.*.x | b.1002.x b.1001.x"), "1001 1002"),
        (("a.1.x a.2.x", "b/v2.????.x | b/v2.0002.x b/v2.0001.x"), "1 2"),
        (("a*.x | ay.1.x ay.2.x", "b*.x | bc.02.x bc.01.x"), "y.1 y.2"),
        (("a.1*.x | a.10.x a.11.x", "b.[0-9]*.x | b.11.x b.10.x"), "10 11"),
        (("a/*.x | a/p.x a/q.x", "b/*.x | b/q.x b/p.x"), "p q"),
        (("a.x", "b*.x | b7.x"), ""),
        (("a8.x", "b9.x"), "8"),
        (("a.*.x | a.3.x", "b.*.x | b.003.x"), "3"),
    ],
)
def test_pairs(home, lines, expected):
    pairs = paired(home, *lines)
    firsts = sorted(first.strip("a./x") for first, _ in pairs)
    assert firsts == sorted(expected.split() or [""])
    for first, second in pairs:
        numbers = [Path(path).suffixes[:1] for path in (first, second)]
        if len(pairs) > 1 and "." in Path(first).stem:
            assert int(numbers[0][0][1:]) == int(numbers[1][0][1:])
        elif len(pairs) > 1:
            assert Path(first).name == Path(second).name


@pytest.mark.parametrize(
    ("lines", "stated"),
    [
        (
            ("a.*.x | a.1.x a.2.x", "b.*.x | b.1.x b.3.x"),
            "a.*.x lacks 3; b.*.x lacks 2",
        ),
        (
            ("t.1001.x t.1002.x", "u.<UDIM>.x | u.1001.x u.1003.x"),
            "u.<UDIM>.x lacks 1002",
        ),
        (("t.1001.x", "u.<UDIM>.x | u.1002.x"), "t.1001.x lacks 1002"),
        (("a.*.x | a.1.x", "b.*.x | b.2.x"), "a.*.x lacks 2; b.*.x lacks 1"),
        (("a.*.x | a.1.x", "b.*.x | b.1.x b.2.x"), "a.*.x lacks"),
        (("a.1*.x | a.10.x a.11.x", "b.*.x | b.0.x b.1.x"), "a.1*.x lacks 0, 1"),
        (("a.*.x | a.2.x a.3.x", "b.*.x | b.2.x b.02.x"), "b.*.x lacks 3"),
        (("a.*.x | a.2.x a.02.x", "b.*.x | b.2.x b.02.x"), "b.*.x has one twice"),
        (("a*.x | ap.x aq.x", "b*.x | br.x bs.x"), "a*.x lacks r, s"),
    ],
)
def test_missing_frames_are_named(home, lines, stated):
    with raises(TextureError, "frames-differ") as caught:
        paired(home, *lines)
    assert stated in str(caught.value)
