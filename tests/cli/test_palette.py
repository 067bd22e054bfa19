"""``uplift palette``."""

from __future__ import annotations

import json

import numpy as np
import pytest

import uplift

SPEC = """
lights.day.illuminant = "D65"
materials.grey.rgb = "#808080"
materials.new.design = true
colours.new.day = "{}"
"""


@pytest.fixture
def spec(home):
    def spec(colour="#a06040"):
        path = home / "spec.toml"
        path.write_text(SPEC.format(colour), encoding="utf-8")
        return path

    return spec


def test_matrix_is_printed(run, spec):
    text = run("palette", spec()).stdout
    assert "#a06040 #a06040" in text
    assert "new*" in text
    assert "not met" not in text


def test_goals_that_cannot_be_met_are_printed(run, spec):
    """A material cannot be brighter than the perfect reflector."""
    path = spec()
    path.write_text(path.read_text().replace('"#a06040"', "[1.2, 1.2, 1.2]"), encoding="utf-8")
    text = run("palette", path).stdout
    (line,) = [line for line in text.splitlines() if line.startswith("not met: ")]
    assert "new" in line
    assert "day" in line
    assert "ΔE00" in line


def test_json_reproduces_the_matrix(run, spec):
    found = json.loads(run("palette", spec(), "--format", "json").stdout)
    assert [part["designed"] for part in found["materials"]] == [False, True]
    light, material = found["lights"][0], found["materials"][1]
    product = np.array(light["coefficients"]) * material["coefficients"]
    (cell,) = (cell for cell in found["colours"] if cell["material"] == "new")
    np.testing.assert_allclose(np.array(found["to_rgb"]) @ product, cell["factor"], atol=1e-12)
    assert found["colours"][0]["wanted"] is None
    assert found["missed"] == []


def test_files_are_written(run, spec, home):
    files = ("-o", "new.txt", "--plot", "m.png", "--plot-spectra", "s.png")
    text = run("palette", spec(), *files).stderr
    assert "new.txt: 1 designed materials" in text
    assert uplift.read_atlas("new.txt").names == ("new",)
    assert all((home / name).read_bytes()[1:4] == b"PNG" for name in ("m.png", "s.png"))


def test_files_are_replaced_only_with_force(refuse, run, spec, home):
    (home / "m.png").write_text("mine")
    assert refuse("palette", spec(), "--plot", "m.png").code == "file-exists"
    run("palette", spec(), "--plot", "m.png", "--force")


def test_invalid_specs_are_errors(refuse, spec):
    error = refuse("palette", spec("reddish"))
    assert error.code == "invalid-colour"
    assert "reddish" in error.problem
    assert refuse("palette", "none.toml").code == "file-not-found"
