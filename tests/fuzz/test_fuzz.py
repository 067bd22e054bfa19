"""Short fuzz campaigns of all readers and of the command line, and the detection of failures."""

from __future__ import annotations

import signal

import numpy as np
import pytest

from tests.fuzz import campaign, commands
from tests.fuzz.campaign import Target, fuzz
from tests.fuzz.targets import COMMANDS, READERS
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
    "build options": (b"auto_tolerance\t99\tnan", b"auto_tolerance\t99\t-1", b"dim\t99\t" + b"9" * 400),
}
"""Inputs that once raised other errors, warned or hung, by reader."""


@pytest.fixture(autouse=True)
def unlimited(monkeypatch):
    """Disable the limit of memory, which would remain in this process."""
    monkeypatch.setattr(campaign, "_limit_memory", lambda: None)


def failures(use, folder, inputs=3):
    target = Target("example", lambda random, path: path.write_bytes(random.bytes(4)), use)
    return fuzz(target, 0, range(inputs), folder, folder).failures


@pytest.mark.parametrize(("name", "inputs"), [*((name, 100) for name in READERS), *((name, 150) for name in COMMANDS)])
def test_inputs_are_accepted_or_rejected(tmp_path, name, inputs):
    tally = fuzz((READERS | COMMANDS)[name], 1, range(inputs), tmp_path, tmp_path)
    assert not tally.failures
    assert tally.accepted + tally.rejected == inputs
    assert min(tally.accepted, tally.rejected) > inputs / 100  # mutations are neither too strong nor too weak


@pytest.mark.parametrize(("name", "content"), [(name, content) for name in FINDS for content in FINDS[name]])
def test_inputs_that_once_failed_are_rejected(tmp_path, name, content):
    target = Target(name, lambda random, path: path.write_bytes(content), READERS[name].use)
    tally = fuzz(target, 0, range(1), tmp_path, tmp_path)
    assert not tally.failures
    assert tally.rejected == (name != "colour table" or b"x" in content)


def test_other_exceptions_are_failures_and_their_inputs_are_kept(tmp_path):
    def use(path):
        raise KeyError("oh")

    assert list(failures(use, tmp_path).values()) == [3]
    assert (tmp_path / "example-0-0").read_bytes() == np.random.default_rng([0, 0]).bytes(4)


def test_warnings_are_failures(tmp_path):
    (failure,) = failures(lambda path: np.float64(1) / np.float64(0), tmp_path)
    assert failure.startswith("RuntimeWarning")


def test_hangs_are_failures_even_if_exceptions_are_caught(tmp_path, monkeypatch):
    monkeypatch.setattr(campaign, "SECONDS", 0.05)

    def use(path):
        try:
            while True:
                pass
        except Exception as error:
            raise UpliftError("slow") from error

    (failure,) = failures(use, tmp_path, 1)
    assert failure.startswith("HangError")
    assert signal.getitimer(signal.ITIMER_PROF) == (0, 0)


def test_texts_that_are_not_escaped_are_found(tmp_path, monkeypatch):
    for module in ("uplift_cli.output.console", "uplift_cli.output.tables", "uplift.common.errors"):
        monkeypatch.setattr(f"{module}.printable", str)
    tally = fuzz(COMMANDS["hostile text"], 1, range(40), tmp_path, tmp_path)
    assert any("a control character" in failure for failure in tally.failures)


def test_inputs_that_are_replaced_are_found(tmp_path, monkeypatch):
    monkeypatch.setattr(commands, "WRITERS", commands.QUICK)
    monkeypatch.setattr("uplift.common.files._check_existing", lambda *_: None)
    tally = fuzz(COMMANDS["outputs that are inputs"], 1, range(40), tmp_path, tmp_path)
    assert any("an input was replaced" in failure for failure in tally.failures)


def test_formulas_are_failures():
    commands.check_csv("'=1,-1.5,1e-9\n")
    with pytest.raises(ValueError, match="formula"):
        commands.check_csv("a,=1\n")
