"""Short fuzz campaigns of all readers and of the command line."""

import pytest

from tests.fuzz import fuzzing
from tests.fuzz.builds import QUICK, broken
from tests.fuzz.commands import COMMANDS
from tests.fuzz.fuzzing import Target, fuzz
from tests.fuzz.readers import READERS

LARGE_COLOUR = b"1e308,0.5,0.2\n"
FINDS = {
    "atlas of an instrument": (
        b"name,400,1e308\ngrey,0.5,0.5\n",
        b"name,inf,inf\ngrey,1e308,1e308\n",
        b"\xef\xbb\xbf",
        b"\xe2\x80\xa8\n",
    ),
    "atlas text": (
        (
            b"Entry ID: a\nSampling information\nType : regular\nStart : 400 "
            b"nm\nIncrement : inf nm\n"
        ),
    ),
    "colour table": (LARGE_COLOUR, b"9" * 5000 + b"x,0,0\n"),
    "scene file": (
        b"textures = " + b"[" * 5000,
        b'textures = ["' + b"x" * 5000 + b'"]',
        b'textures = ["a\\u0000*"]',
    ),
    "plan": (b'{"a":' * 5000, b'{"format": 1, "format": NaN}'),
    "palette": (b"lights = " + b"[" * 5000,),
}
"""Inputs that once raised other errors, warned or hung, by reader."""


@pytest.fixture(autouse=True)
def unlimited(monkeypatch):
    """Disable the limit of memory, which would remain in this process."""
    monkeypatch.setattr(fuzzing, "_limit_memory", lambda: None)


@pytest.mark.parametrize(
    "target", [*READERS.values(), *COMMANDS.values()], ids=lambda target: target.name
)
def test_inputs_are_accepted_or_rejected(tmp_path, target):
    tally = fuzz(target, 1, range(50), tmp_path, tmp_path)
    # Mutations are neither too strong nor too weak.
    assert set(tally) == {"accepted", "rejected"}


@pytest.mark.parametrize("name", FINDS)
def test_inputs_that_once_failed_are_rejected(tmp_path, name):
    for content in FINDS[name]:
        target = Target(
            name,
            lambda random, path, data=content: path.write_bytes(data),
            READERS[name].use,
        )
        tally = fuzz(target, 0, range(1), tmp_path, tmp_path)
        assert list(tally) == ["accepted" if content == LARGE_COLOUR else "rejected"]


@pytest.mark.parametrize("seed", range(6))
def test_odd_builds_keep_the_laws(seed):
    """`make nightly` runs thousands, of more kinds."""
    assert not broken(seed, QUICK)
