"""``uplift info``."""

from __future__ import annotations

import json

import uplift
from uplift.cube import digest

from .conftest import SMALL


def test_json_holds_the_facts(run):
    facts = json.loads(run("info", SMALL, "--format", "json").stdout)
    data = uplift.load(SMALL).data
    assert (facts["dim"], facts["points"], facts["coefficients"]) == (8, 512, 9)
    assert facts["status"] == data.counts()
    assert sum(facts["status"].values()) == 512
    assert facts["entries"] == list(data.atlas.names)
    assert facts["digest"] == digest(data)
    assert facts["provenance"]["atlases"][0]["name"] == "macbeth.txt"
    assert facts["provenance"]["left_out"] == ["cyan"]


def test_the_table_tells_the_same(run):
    out = run("info", SMALL).stdout
    for text in (SMALL, "sRGB", "D65", "atlas primary", "macbeth.txt", "left out", "cyan", "option lights"):
        assert text in out


def test_without_a_file_it_tells_of_the_package_s_own_cube(run):
    assert json.loads(run("info", "--format", "json").stdout)["dim"] == 16


def test_what_is_no_cube_is_refused(refused, elsewhere):
    (elsewhere / "a.uplift").write_bytes(b"PK\3\4" * 100)
    assert "a.uplift: is not a cube file" in refused("info", "a.uplift")
