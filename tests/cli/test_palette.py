"""``uplift lab palette``."""

import numpy as np
from PIL import Image

import uplift

SPEC = """
lights.day.illuminant = "D65"
materials.grey.rgb = "#808080"
materials.new.design = true
colours.new.day = "#a06040"
"""
PAIR = """
lights.day.illuminant = "D65"
lights.lamp.illuminant = "FL11"
materials.leaf.rgb = "#306020"
materials."old brick".rgb = "#c05040"
"""


def test_the_matrix_and_goals_that_cannot_be_met_are_printed(run, home):
    """A material cannot be brighter than the perfect reflector."""
    (home / "spec.toml").write_text(SPEC)
    text = run("lab palette spec.toml").stdout
    assert "#a06040 #a06040" in text
    assert "not met" not in text
    brighter = SPEC.replace('"#a06040"', "[1.2, 1.2, 1.2]")
    (home / "spec.toml").write_text(brighter)
    assert "\nnot met: new under day" in run("lab palette spec.toml").stdout


def test_files_are_written(run, home):
    (home / "spec.toml").write_text(SPEC)
    run("lab palette spec.toml -o new.txt --plot m.png --plot-spectra s.png")
    assert uplift.read_atlas("new.txt").names == ("new",)
    for name in ("m.png", "s.png"):
        assert (home / name).read_bytes().startswith(b"\x89PNG")


def test_pages(run, home):
    (home / "two.toml").write_text(PAIR)
    run("lab palette --html two.html two.toml")
    assert ">old brick</button>" in (home / "two.html").read_text("utf-8")
    labels = np.array([[(255, 0, 0), (0, 0, 255), (0, 0, 0)]], np.uint8)
    Image.fromarray(labels).save(home / "labels.png")
    words = "--image labels.png --label leaf=#ff0000 --label 'old brick=#0000ff'"
    run(f"lab palette two.toml --html three.html {words}")
    assert 'width="3" height="1"' in (home / "three.html").read_text("utf-8")
