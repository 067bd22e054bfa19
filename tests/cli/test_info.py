"""``uplift info``."""

import re
import shlex

from uplift_cli.commands.build import command as build

import uplift
from uplift.cube.file import digest


def test_json_has_all_fields(ask, cubes):
    path = cubes / "moments-8-macbeth.uplift"
    data = uplift.load(path).data
    facts = ask("info", path)
    assert (facts["dim"], facts["nodes"], facts["coefficients"]) == (8, 512, 9)
    assert facts["status"] == data.points.counts()
    assert facts["entries"] == list(data.atlas.names)
    assert facts["mean_standard_error"] == data.points.standard_error.mean(dtype=float)
    assert facts["rounds"] == data.points.round.max() + 1
    assert facts["provenance"]["left_out"] == ["cyan"]
    assert facts["digest"] == digest(data)


def test_options_are_those_of_the_command_line(run, cubes, monkeypatch):
    monkeypatch.setenv("COLUMNS", "2000")
    for path in cubes.iterdir():
        (line,) = re.findall(r"^options +(.*)", run("info", path).stdout, re.MULTILINE)
        values = build.make_context("build", shlex.split(line)).params
        data = uplift.load(path).data
        assert values["limits"] == (380, 780)
        assert values["dim"] == data.lattice.dim
        assert values["model"] == data.model.name
