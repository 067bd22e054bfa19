"""``uplift check --kit`` and ``--renderer``."""

from benchmarks.conformance import CUBE, KIT
from uplift.extras.report.conformance_kit import kit_names


def test_a_kit_is_written_and_passes(run, refuse, home):
    result = run("check --kit kit")
    assert result.stdout.startswith("kit: conformance.uplift, ")
    assert {path.name for path in (home / "kit").iterdir()} == set(kit_names())
    for file in ("reference-A.exr", "spectra.csv"):
        assert "passed" in run("check --renderer", home / "kit" / file).stdout
    assert refuse("check --kit kit").code == "file-exists"
    cube = "kit/conformance.uplift"
    assert refuse("check --kit kit --force", cube).code == "output-is-input"
    assert refuse("check --kit new none.uplift").code == "file-not-found"
    assert not (home / "new").exists()
    run("check --kit kit --force")


def test_failures_are_explained_and_exit_with_1(run, ask):
    picture = KIT / "reference-FL11.exr"
    shown = run("check --renderer", picture, CUBE, code=1).stdout
    assert "FAILED" in shown
    assert "the light is FL11" in shown
    found = ask("check --renderer", picture, CUBE, code=1)
    assert (found["passed"], found["light"]) == (False, "A")
    assert found["delta_e"]["mean"] > found["limits"]["mean"]
    assert found["explanation"] == "the light is FL11"
    assert len(found["worst"]) == 5
    assert ask("check --light FL11 --renderer", picture, CUBE)["passed"]


def test_a_plot_is_drawn_and_replaces_no_input(run, refuse, home):
    picture = KIT / "reference-FL11.exr"
    run("check --plot a.png --renderer", picture, CUBE, code=1)
    assert (home / "a.png").read_bytes().startswith(b"\x89PNG")
    assert refuse("check --plot a.png --renderer", picture, CUBE).code == "file-exists"
    run("check --force --plot a.png --renderer", KIT / "spectra.csv", CUBE)
    (home / "b.png").write_bytes(picture.read_bytes())
    words = "check --force --plot b.png --renderer b.png"
    assert refuse(words, CUBE).code == "output-is-input"
