"""``uplift wavelengths``."""

from __future__ import annotations

import csv
import io
import json

import matplotlib.image
import numpy as np
import pytest

from uplift import read_atlas
from uplift.atlas import on_grid
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab


@pytest.fixture
def choose(run, macbeth):
    """What the command prints for the ColorChecker."""
    return lambda *args, **options: run("wavelengths", "--atlas", macbeth, *args, **options).stdout


def test_the_json_is_all_that_a_renderer_needs(choose, macbeth):
    """Rendered by hand: colours of the ColorChecker from the printed numbers alone."""
    answer = json.loads(choose("--count", 6, "--light", "D65", "--light", "FL11", "--format", "json"))
    assert (answer["count"], answer["materials"], answer["method"]) == (6, 24, "optimised")
    nm, weights = np.array(answer["wavelengths"]), np.array(answer["to_xyz"])
    atlas = read_atlas(macbeth)
    for light in ("D65", "FL11"):
        seen = on_grid(atlas, nm) * answer["powers"][light] @ weights
        power = observer.illuminant_spd(light, 380, 770, 1)
        cmfs = observer.matching_functions(observer.DEFAULT_OBSERVER, 380, 770, 1)
        lit = (cmfs * power[:, None] / (cmfs[:, 1] @ power)).T
        exact = on_grid(atlas, np.arange(380.0, 771.0)) @ lit.T
        white = lit.sum(axis=1)
        apart = delta_e_2000(lab(seen, white), lab(exact, white))
        stated = answer["errors"][light]
        # Between 1 nm samples the command takes splines, this test the atlas's own interpolation.
        assert stated["mean"] == pytest.approx(apart.mean(), abs=0.02)
        assert stated["max"] == pytest.approx(apart.max(), abs=0.05)
        assert stated["worst"] == atlas.names[int(apart.argmax())]
    assert answer["errors"]["all lights"]["max"] == max(answer["errors"][k]["max"] for k in ("D65", "FL11"))


def test_weights_to_rgb_show_white_under_the_illuminant(choose):
    answer = json.loads(
        choose("--count", 10, "--light", "D65", "--space", "ITU-R BT.2020", "--format", "json")
    )
    white = np.array(answer["powers"]["D65"]) @ answer["to_rgb"]
    np.testing.assert_allclose(white, 1, atol=5e-3)


def test_csv_and_table_show_the_same(choose):
    rows = list(csv.DictReader(io.StringIO(choose("--count", 5, "--light", "FL2", "--format", "csv"))))
    assert list(rows[0]) == ["wavelength", "X", "Y", "Z", "r", "g", "b", "power FL2"]
    table = choose("--count", 5, "--light", "FL2")
    assert len(rows) == 5
    for row in rows:
        assert f"{float(row['wavelength']):.1f}" in table
        assert f"{float(row['power FL2']):.4f}" in table
    assert "all lights" not in table


def test_a_target_is_kept(choose):
    answer = json.loads(choose("--target", 1, "--measure", "p95", "--format", "json"))
    assert answer["errors"]["D65"]["p95"] <= 1
    fewer = json.loads(choose("--count", answer["count"] - 1, "--format", "json"))
    assert fewer["errors"]["D65"]["p95"] > 1


def test_meyer_s_four(choose):
    answer = json.loads(choose("--count", 4, "--method", "meyer", "--light", "C", "--format", "json"))
    np.testing.assert_allclose(answer["wavelengths"], [456.4, 490.9, 557.7, 631.4], atol=0.1)


def test_draws(choose, home):
    choose("--count", 4, "--light", "A", "--light", "FL11", "--plot", "a.png", "--method", "bins")
    picture = matplotlib.image.imread(home / "a.png")
    assert picture.shape[0] > 400
    assert picture[..., :3].std() > 0.05


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        (["--count", "0"], "count must be in [1, 40], got 0"),
        (["--count", "4", "--light", "D66"], "unknown illuminant 'D66'; did you mean"),
        (["--target", "-1"], "target must be positive, got -1"),
        (["--target", "0.001", "--method", "uniform"], "no count up to 40 meets a max ΔE00 of 0.001"),
        (["--count", "3", "--method", "meyer"], "method 'meyer' has no rule of 3 wavelengths"),
        (["--wavelengths", "300:700:50"], "wavelengths must be distinct and within [380, 770] nm"),
        (["--wavelengths", "some"], "wavelengths 'some' are not clear"),
        (["--count", "4", "--observer", "me"], "unknown observer 'me'"),
    ],
)
def test_bad_options_are_told_in_one_line(refuse, macbeth, options, problem):
    assert problem in refuse("wavelengths", "--atlas", macbeth, *options)


def test_given_wavelengths(choose):
    answer = json.loads(choose("--wavelengths", "420:660:40", "--format", "json"))
    assert answer["wavelengths"] == [420, 460, 500, 540, 580, 620, 660]
    assert answer["method"] == "given"
    plain = json.loads(choose("--count", 7, "--method", "bins", "--format", "json"))
    assert answer["errors"]["D65"]["mean"] < plain["errors"]["D65"]["mean"] / 2


@pytest.mark.parametrize(
    "options", [[], ["--count", "4", "--target", "1"], ["--wavelengths", "500", "--count", "1"]]
)
def test_one_of_count_target_and_at(run, options):
    assert "give one" in run("wavelengths", *options, code=2).output


def test_an_existing_picture_is_kept(refuse, home, macbeth):
    (home / "a.png").write_text("mine")
    assert "a.png" in refuse("wavelengths", "--atlas", macbeth, "--count", "4", "--plot", "a.png")
    assert (home / "a.png").read_text() == "mine"


@pytest.mark.parametrize(
    "options", [["--count", "4", "--measure", "mean"], ["--wavelengths", "500", "--method", "bins"]]
)
def test_nothing_asked_for_is_left_aside(run, options):
    assert "--measure goes with --target, --method with" in run("wavelengths", *options, code=2).output
