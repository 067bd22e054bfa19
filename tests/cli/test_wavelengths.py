"""``uplift lab wavelengths``."""

import matplotlib.image
import pytest
from numpy.testing import assert_allclose


@pytest.fixture
def choose(run, macbeth):
    """Standard output for the ColorChecker."""
    return lambda *args, **options: (
        run("lab wavelengths --atlas", macbeth, *args, **options).stdout
    )


@pytest.fixture
def answer(ask, macbeth):
    """Answer in JSON for the ColorChecker."""
    return lambda *args: ask("lab wavelengths --atlas", macbeth, *args)


def test_plot(choose, home):
    choose(
        "--count",
        4,
        "--light",
        "A",
        "--light",
        "FL11",
        "--plot",
        "a.png",
        "--method",
        "bins",
    )
    picture = matplotlib.image.imread(home / "a.png")
    assert picture.shape[0] > 400
    assert picture[..., :3].std() > 0.05


def test_given_wavelengths(answer):
    found = answer("--wavelengths", "420:660:40")
    assert found["wavelengths"] == [420, 460, 500, 540, 580, 620, 660]
    assert found["method"] == "given"
    plain = answer("--count", 7, "--method", "bins")
    assert found["errors"]["D65"]["mean"] < plain["errors"]["D65"]["mean"] / 2


def test_orders_of_the_channels(answer):
    found = answer("--orders", 3, 2, 1, "--light", "C")
    assert (found["count"], found["method"]) == (6, "meyer")
    assert_allclose(
        answer("--count", 4, "--method", "meyer", "--light", "C")["wavelengths"],
        [456.4, 490.9, 557.7, 631.4],
        atol=0.1,
    )
    cones = answer("--orders", 3, 2, 1, "--channels", "cones", "--light", "C")
    assert cones["wavelengths"] != found["wavelengths"]
