"""``uplift palette``."""

from __future__ import annotations

import json

import numpy as np
import pytest

import uplift

WISHES = """
lights.day.illuminant = "D65"
materials.grey.rgb = "#808080"
materials.new.design = true
colours.new.day = "{}"
"""


@pytest.fixture
def spec(home):
    def spec(colour="#a06040"):
        path = home / "spec.toml"
        path.write_text(WISHES.format(colour), encoding="utf-8")
        return path

    return spec


def test_the_matrix_is_printed(run, spec):
    text = run("palette", spec()).stdout
    assert "#a06040 #a06040" in text
    assert "new*" in text
    assert "all wishes are fulfilled" in text


def test_what_is_missed_is_printed_with_what_to_relax(run, spec):
    """Brighter than white paper under the same light."""
    path = spec()
    path.write_text(path.read_text().replace('"#a06040"', "[1.2, 1.2, 1.2]"), encoding="utf-8")
    text = run("palette", path).stdout
    assert "missed: new under day: missed by ΔE00" in text
    assert "relax the bounds of new (then 0.0" in text


def test_json_holds_what_a_program_needs(run, spec):
    found = json.loads(run("palette", spec(), "--format", "json").stdout)
    assert [part["designed"] for part in found["materials"]] == [False, True]
    light, material = found["lights"][0], found["materials"][1]
    product = np.array(light["coefficients"]) * material["coefficients"]
    (cell,) = (cell for cell in found["colours"] if cell["material"] == "new")
    np.testing.assert_allclose(np.array(found["to_rgb"]) @ product, cell["factor"], atol=1e-12)
    assert found["colours"][0]["wanted"] is None
    assert found["missed"] == []


def test_files_are_written(run, spec, home):
    files = ("--atlas", "new.txt", "--matrix", "m.png", "--spectra", "s.png")
    text = run("palette", spec(), *files).stderr
    assert "new.txt: 1 designed materials" in text
    assert uplift.read_atlas("new.txt").names == ("new",)
    assert all((home / name).read_bytes()[1:4] == b"PNG" for name in ("m.png", "s.png"))


def test_files_are_not_replaced_unasked(refuse, run, spec, home):
    (home / "m.png").write_text("mine")
    assert "exists already" in refuse("palette", spec(), "--matrix", "m.png")
    run("palette", spec(), "--matrix", "m.png", "--force")


def test_faulty_specs_are_one_line(refuse, spec):
    assert "'day' is 'reddish', no colour" in refuse("palette", spec("reddish"))
    assert "cannot be read" in refuse("palette", "none.toml")
