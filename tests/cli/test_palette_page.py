"""``uplift palette --html``: the light dial."""

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


def test_a_page_is_written_with_the_package_s_picture(run, spec, home):
    assert "two.html: light dial" in run("palette", spec, "--html", "two.html").stderr
    text = (home / "two.html").read_text(encoding="utf-8")
    assert "<title>two – uplift palette</title>" in text
    assert 'width="512" height="512"' in text
    assert ">old brick</button>" in text


def test_a_page_is_written_with_a_picture_of_one_s_own(run, spec, home):
    labels = ("--label", "leaf=#ff0000", "--label", "old brick=#0000ff")
    run("palette", spec, "--html", "two.html", "--image", "labels.png", *labels)
    assert 'width="3" height="1"' in (home / "two.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--image", "labels.png"), "--image without --html; name the page"),
        (("--html", "a.html", "--label", "leaf=#ff0000"), "--label without --image; name the image"),
        (
            ("--html", "a.html", "--image", "labels.png", "--label", "leaf"),
            "label 'leaf' has no colour; write",
        ),
        (("--html", "a.html", "--image", "labels.png"), "2 pixels have no material: #"),
        (
            ("--html", "a.html", "--image", "labels.png", "--label", "leaf=#1", "--label", "leaf=#2"),
            "two colours for 'leaf'; give one",
        ),
        (("--html", "two.toml"), "two.toml: exists already; use --force"),
    ],
)
def test_what_cannot_be_meant_is_refused_before_any_work(refuse, spec, home, arguments, told):
    assert told in refuse("palette", spec, *arguments)
    assert not (home / "a.html").exists()
