"""Short fuzz campaigns of all readers and of the command line, and the detection of failures."""

from __future__ import annotations

import numpy as np
import pytest

from tests.fuzz import fuzzing
from tests.fuzz.commands import COMMANDS, check_csv
from tests.fuzz.fuzzing import Target, fuzz
from tests.fuzz.readers import READERS
from uplift.common.errors import UpliftError

FINDS = {
    "atlas table": (
        b"name,400,1e308\ngrey,0.5,0.5\n",
        b"name,inf,inf\ngrey,1e308,1e308\n",
        b"\xef\xbb\xbf",
        b"\xe2\x80\xa8\n",
    ),
    "atlas text": (b"Entry ID: a\nSampling information\nType : regular\nStart : 400 nm\nIncrement : inf nm\n",),
    "colour table": (b"1e308,0.5,0.2\n", b"9" * 5000 + b"x,0,0\n"),
    "scene file": (b"textures = " + b"[" * 5000, b'textures = ["' + b"x" * 5000 + b'"]', b'textures = ["a\\u0000*"]'),
    "plan": (b'{"a":' * 5000, b'{"format": 1, "format": NaN}'),
    "palette": (b"lights = " + b"[" * 5000,),
}
"""Inputs that once raised other errors, warned or hung, by reader."""


@pytest.fixture(autouse=True)
def unlimited(monkeypatch):
    """Disable the limit of memory, which would remain in this process."""
    monkeypatch.setattr(fuzzing, "_limit_memory", lambda: None)


@pytest.mark.parametrize("target", [*READERS.values(), *COMMANDS.values()], ids=lambda target: target.name)
def test_inputs_are_accepted_or_rejected(tmp_path, target):
    tally = fuzz(target, 1, range(100), tmp_path, tmp_path)
    assert set(tally) == {"accepted", "rejected"}  # mutations are neither too strong nor too weak


@pytest.mark.parametrize(("name", "content"), [(name, content) for name in FINDS for content in FINDS[name]])
def test_inputs_that_once_failed_are_rejected(tmp_path, name, content):
    target = Target(name, lambda random, path: path.write_bytes(content), READERS[name].use)
    (outcome,) = fuzz(target, 0, range(1), tmp_path, tmp_path)
    assert outcome == ("rejected" if name != "colour table" or b"x" in content else "accepted")


def hang(path):
    try:
        while True:
            pass
    except Exception as error:
        raise UpliftError("slow") from error


@pytest.mark.parametrize(
    ("use", "failure"),
    [
        (lambda path: {}["oh"], "KeyError"),
        (lambda path: np.float64(1) / np.float64(0), "RuntimeWarning"),
        (hang, "Hang"),
    ],
)
def test_other_errors_warnings_and_hangs_are_failures_whose_inputs_are_kept(tmp_path, monkeypatch, use, failure):
    monkeypatch.setattr(fuzzing, "SECONDS", 0.05)
    target = Target("example", lambda random, path: path.write_bytes(random.bytes(4)), use)
    ((found, count),) = fuzz(target, 0, range(2), tmp_path, tmp_path).items()
    assert found.startswith(failure)
    assert count == 2
    assert (tmp_path / "example-0-0").read_bytes() == np.random.default_rng([0, 0]).bytes(4)


def test_texts_that_are_not_escaped_are_found(tmp_path, monkeypatch):
    for module in ("uplift_cli.output.console", "uplift_cli.output.tables", "uplift.common.errors"):
        monkeypatch.setattr(f"{module}.printable", str)
    tally = fuzz(COMMANDS["hostile text"], 1, range(40), tmp_path, tmp_path)
    assert any("a control character" in failure for failure in tally)


def test_formulas_are_failures():
    check_csv("'=1,-1.5,1e-9\n")
    with pytest.raises(ValueError, match="formula"):
        check_csv("a,=1\n")
