"""``uplift lab palette``."""

import matplotlib.image
import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift

SPEC = """
lights.day.illuminant = "D65"
materials.grey.rgb = "#808080"
materials.new.design = true
colours.new.day = "{}"
"""
PAIR = """
lights.day.illuminant = "D65"
lights.lamp.illuminant = "FL11"
materials.leaf.rgb = "#306020"
materials."old brick".rgb = "#c05040"
"""


@pytest.fixture
def spec(home):
    """A material to design, by the colour that it is to have."""

    def spec(colour="#a06040"):
        (home / "spec.toml").write_text(SPEC.format(colour), encoding="utf-8")
        return "spec.toml"

    return spec


@pytest.fixture
def pair(home):
    """Two given materials, and an image of labels."""
    (home / "two.toml").write_text(PAIR, encoding="utf-8")
    labels = np.array([[(255, 0, 0), (0, 0, 255), (0, 0, 0)]], np.uint8)
    matplotlib.image.imsave(home / "labels.png", labels)
    return "two.toml"


def test_the_matrix_and_goals_that_cannot_be_met_are_printed(run, spec, home):
    """A material cannot be brighter than the perfect reflector."""
    text = run("lab palette", spec()).stdout
    assert "#a06040 #a06040" in text
    assert "new*" in text
    assert "not met" not in text
    path = home / spec()
    path.write_text(
        path.read_text().replace('"#a06040"', "[1.2, 1.2, 1.2]"), encoding="utf-8"
    )
    (line,) = [
        line
        for line in run("lab palette", path).stdout.splitlines()
        if line.startswith("not met: ")
    ]
    assert all(word in line for word in ("new", "day", "ΔE00"))


def test_json_reproduces_the_matrix(ask, spec):
    found = ask("lab palette", spec())
    assert [part["designed"] for part in found["materials"]] == [False, True]
    light = found["lights"][0]
    material = found["materials"][1]
    product = np.array(light["coefficients"]) * material["coefficients"]
    (cell,) = (cell for cell in found["colours"] if cell["material"] == "new")
    assert_allclose(np.array(found["to_rgb"]) @ product, cell["factor"], atol=1e-12)
    assert found["colours"][0]["wanted"] is None
    assert found["missed"] == []
    for parts, name in ((found["materials"], "dual"), (found["lights"], "light_dual")):
        for part in parts:
            assert_allclose(
                np.array(found[name]) @ part["samples"], part["coefficients"], atol=1e-9
            )


def test_files_are_written(run, refuse, spec, home):
    files = "-o new.txt --plot m.png --plot-spectra s.png"
    assert (
        "new.txt: 1 designed material\n" in run(f"lab palette {spec()} {files}").stderr
    )
    assert uplift.read_atlas("new.txt").names == ("new",)
    assert all((home / name).read_bytes()[1:4] == b"PNG" for name in ("m.png", "s.png"))
    assert refuse("lab palette --plot m.png", spec()).code == "file-exists"
    run("lab palette --plot m.png --force", spec())


def test_pages(run, pair, home):
    assert run("lab palette --html two.html", pair).stderr.startswith("two.html: ")
    text = (home / "two.html").read_text("utf-8")
    assert 'width="512" height="512"' in text
    assert ">old brick</button>" in text
    labels = "--label leaf=#ff0000 --label 'old brick=#0000ff'"
    run(f"lab palette {pair} --html three.html --image labels.png {labels}")
    assert 'width="3" height="1"' in (home / "three.html").read_text("utf-8")


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        ("--html a.html --image labels.png --label leaf", "option"),
        ("--html a.html --image labels.png", "texture"),
        (
            "--html a.html --image labels.png --label leaf=#1 --label leaf=#2",
            "option",
        ),
        ("--html two.toml", "output"),
    ],
)
def test_invalid_input_is_reported_before_any_work(
    refuse, pair, home, monkeypatch, arguments, code
):
    monkeypatch.setattr(
        "uplift.extras.papers.palette.design", lambda *_: pytest.fail("designed")
    )
    assert refuse(f"lab palette {pair} {arguments}").code == code
    assert not (home / "a.html").exists()
    assert refuse("lab palette none.toml").code == "file-not-found"
