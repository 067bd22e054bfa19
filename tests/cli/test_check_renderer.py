"""``uplift check --kit`` and ``--renderer``."""

import os

from benchmarks.conformance import CUBE, KIT
from uplift.extras.report.conformance_kit import kit_names


def test_a_kit_is_written_and_passes(run, refuse, home):
    run("check --kit kit")
    assert set(os.listdir(home / "kit")) == set(kit_names())
    for file in ("reference-A.exr", "spectra.csv"):
        assert "passed" in run("check --renderer", home / "kit" / file).stdout
    assert refuse("check --kit kit").code == "file-exists"
    cube = "kit/conformance.uplift"
    assert refuse("check --kit kit --force", cube).code == "output-is-input"
    run("check --kit kit --force")


def test_failures_are_explained_and_exit_with_1(run, ask):
    picture = KIT / "reference-FL11.exr"
    words = ("check --renderer", picture, CUBE)
    assert "the light is FL11" in run(*words, code=1).stdout
    found = ask(*words, code=1)
    assert (found["passed"], found["light"]) == (False, "A")
    assert found["delta_e"]["mean"] > found["limits"]["mean"]
    assert found["explanation"] == "the light is FL11"
    assert ask("check --light FL11 --renderer", picture, CUBE)["passed"]


def test_a_plot_is_drawn_and_replaces_no_input(run, refuse, home):
    picture = KIT / "reference-FL11.exr"
    run("check --plot a.png --renderer", picture, CUBE, code=1)
    assert (home / "a.png").read_bytes().startswith(b"\x89PNG")
    assert refuse("check --plot a.png --renderer", picture, CUBE).code == "file-exists"
    words = "check --force --plot a.png --renderer"
    assert refuse(words, "a.png", CUBE).code == "output-is-input"
    run(words, KIT / "spectra.csv", CUBE)
