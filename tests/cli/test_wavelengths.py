"""``uplift wavelengths``."""

import matplotlib.image
import numpy as np
import pytest

from uplift import read_atlas
from uplift.atlas import on_grid
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab


@pytest.fixture
def choose(run, macbeth):
    """Standard output for the ColorChecker."""
    return lambda *args, **options: run("wavelengths", "--atlas", macbeth, *args, **options).stdout


@pytest.fixture
def answer(ask, macbeth):
    """Answer in JSON for the ColorChecker."""
    return lambda *args: ask("wavelengths", "--atlas", macbeth, *args)


def test_errors_follow_from_the_printed_wavelengths_and_weights(answer, macbeth):
    """Compute the colours of the ColorChecker from the JSON output and compare them with the spectral sums."""
    found = answer("--count", 6, "--light", "D65", "--light", "FL11")
    assert (found["count"], found["materials"], found["method"]) == (6, 24, "optimised")
    nm, weights = np.array(found["wavelengths"]), np.array(found["to_xyz"])
    atlas = read_atlas(macbeth)
    for light in ("D65", "FL11"):
        rendered = on_grid(atlas, nm) * found["powers"][light] @ weights
        power = observer.illuminant_spd(light, 380, 770, 1)
        cmfs = observer.matching_functions(observer.DEFAULT_OBSERVER, 380, 770, 1)
        lit = (cmfs * power[:, None] / (cmfs[:, 1] @ power)).T
        exact = on_grid(atlas, np.arange(380.0, 771.0)) @ lit.T
        white = lit.sum(axis=1)
        errors = delta_e_2000(lab(rendered, white), lab(exact, white))
        stated = found["errors"][light]
        # The command interpolates between samples by splines, this test linearly as the atlas does.
        assert stated["mean"] == pytest.approx(errors.mean(), abs=0.02)
        assert stated["max"] == pytest.approx(errors.max(), abs=0.05)
        assert stated["worst"] == atlas.names[int(errors.argmax())]
    assert found["errors"]["all lights"]["max"] == max(found["errors"][k]["max"] for k in ("D65", "FL11"))


def test_plot(choose, home):
    choose("--count", 4, "--light", "A", "--light", "FL11", "--plot", "a.png", "--method", "bins")
    picture = matplotlib.image.imread(home / "a.png")
    assert picture.shape[0] > 400
    assert picture[..., :3].std() > 0.05


@pytest.mark.parametrize(
    ("options", "code"),
    [
        ("--count 0", "option"),
        ("--count 4 --light D66", "unknown-name"),
        ("--count 3 --method meyer", "undefined-rule"),
    ],
)
def test_invalid_options_are_errors(refuse, macbeth, options, code):
    assert refuse("wavelengths", "--atlas", macbeth, *options.split()).code == code


def test_given_wavelengths(answer):
    found = answer("--wavelengths", "420:660:40")
    assert found["wavelengths"] == [420, 460, 500, 540, 580, 620, 660]
    assert found["method"] == "given"
    plain = answer("--count", 7, "--method", "bins")
    assert found["errors"]["D65"]["mean"] < plain["errors"]["D65"]["mean"] / 2


@pytest.mark.parametrize(
    ("options", "name"),
    [
        ("", "--count"),
        ("--count 4 --tolerance 1", "--tolerance"),
        ("--wavelengths 500 --count 1", "--wavelengths"),
        ("--orders 3 2 1 --count 4", "--orders"),
        ("--wavelengths 500 --method bins", "--method"),
    ],
)
def test_options_that_exclude_or_need_others(misuse, options, name):
    assert name in misuse("wavelengths", *options.split())


def test_orders_of_the_channels(answer):
    found = answer("--orders", 3, 2, 1, "--light", "C")
    assert (found["count"], found["method"]) == (6, "meyer")
    np.testing.assert_allclose(
        answer("--count", 4, "--method", "meyer", "--light", "C")["wavelengths"], [456.4, 490.9, 557.7, 631.4], atol=0.1
    )
    cones = answer("--orders", 3, 2, 1, "--channels", "cones", "--light", "C")
    assert cones["wavelengths"] != found["wavelengths"]
