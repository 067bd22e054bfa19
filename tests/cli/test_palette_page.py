"""``uplift palette --html``: the relighting page."""

from __future__ import annotations

import matplotlib.image
import numpy as np
import pytest

SPEC = """
lights.day.illuminant = "D65"
lights.lamp.illuminant = "FL11"
materials.leaf.rgb = "#306020"
materials."old brick".rgb = "#c05040"
"""
LEAF, OTHER = (255, 0, 0), (0, 0, 255)


@pytest.fixture
def spec(home):
    path = home / "two.toml"
    path.write_text(SPEC, encoding="utf-8")
    matplotlib.image.imsave(home / "labels.png", np.array([[LEAF, OTHER, (0, 0, 0)]], np.uint8))
    return path


def test_default_picture(run, spec, home):
    assert run("palette", spec, "--html", "two.html").stderr.startswith("two.html: ")
    text = (home / "two.html").read_text(encoding="utf-8")
    assert "<title>two – uplift palette</title>" in text
    assert 'width="512" height="512"' in text
    assert ">old brick</button>" in text


def test_picture_from_an_image_of_labels(run, spec, home):
    labels = ("--label", "leaf=#ff0000", "--label", "old brick=#0000ff")
    run("palette", spec, "--html", "two.html", "--image", "labels.png", *labels)
    assert 'width="3" height="1"' in (home / "two.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (("--html", "a.html", "--image", "labels.png", "--label", "leaf"), "option"),
        (("--html", "a.html", "--image", "labels.png"), "texture"),
        (("--html", "a.html", "--image", "labels.png", "--label", "leaf=#1", "--label", "leaf=#2"), "option"),
        (("--html", "two.toml"), "output-is-input"),
    ],
)
def test_invalid_input_is_reported_before_any_work(refuse, spec, home, monkeypatch, arguments, code):
    monkeypatch.setattr("uplift.design.palette.design", lambda *_: pytest.fail("designed"))
    assert refuse("palette", spec, *arguments).code == code
    assert not (home / "a.html").exists()


@pytest.mark.parametrize("arguments", [("--image", "labels.png"), ("--html", "a.html", "--label", "leaf=#ff0000")])
def test_options_that_need_others(misuse, spec, arguments):
    misuse("palette", spec, *arguments)
