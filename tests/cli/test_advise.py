"""``uplift advise``, and textures with standard errors."""

import pytest

from uplift.samples import sample_path


def test_command_prints_its_advice(run, ask, cubes):
    file = cubes / "moments-16-macbeth.uplift"
    wood = sample_path("wood.png")
    words = ("advise", wood, "--cube", file, "--light", "FL11", "--count", 2)
    found = ask(*words, "--plot", "a.png")
    assert list(found["lights"]) == ["FL11"]
    first, second = found["swatches"]
    errors = {stage: each["mean"] for stage, each in found["lights"]["FL11"].items()}
    assert first["gain"] > second["gain"] > 0
    assert errors["before"] - first["gain"] == pytest.approx(first["mean_after"])
    assert second["mean_after"] == pytest.approx(errors["after"])
    assert first["hex"] in run(*words).stdout


def test_second_lights_are_ranked(run, ask, cubes):
    wood = sample_path("wood.png")
    names = ("--candidate", "A", "--candidate", "led", "--light", "FL11")
    found = ask("advise", wood, "--second-light", *names)
    means = [row["mean"] for row in found["second_lights"]]
    assert means == sorted(means)
    assert found["without"]["mean"] > means[-1]
    assert {row["light"] for row in found["second_lights"]} == {"A", "LED-B3"}
    table = run("advise", wood, "--second-light", "--cube", cubes / "moments-8.uplift")
    assert "LED-RGB1" in table.stdout
