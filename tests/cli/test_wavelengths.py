"""``uplift lab wavelengths``."""

import pytest
from numpy.testing import assert_allclose


@pytest.fixture
def answer(ask, macbeth):
    """Answer in JSON for the ColorChecker."""
    return lambda words: ask(f"lab wavelengths {words} --atlas", macbeth)


def test_given_wavelengths(answer):
    found = answer("--wavelengths 420:660:40")
    assert found["wavelengths"] == [420, 460, 500, 540, 580, 620, 660]
    assert found["method"] == "given"
    plain = answer("--count 7 --method bins")
    assert found["errors"]["D65"]["mean"] < plain["errors"]["D65"]["mean"] / 2


def test_orders_of_the_channels(answer):
    found = answer("--orders 3 2 1 --light C")
    assert (found["count"], found["method"]) == (6, "meyer")
    four = answer("--count 4 --method meyer --light C")["wavelengths"]
    assert_allclose(four, [456.4, 490.9, 557.7, 631.4], atol=0.1)
    cones = answer("--orders 3 2 1 --channels cones --light C --plot a.png")
    assert cones["wavelengths"] != found["wavelengths"]


def test_table_and_plot(run, home, macbeth):
    words = "lab wavelengths --count 4 --light A --method bins --plot a.png --atlas"
    run(words, macbeth)
    assert (home / "a.png").read_bytes().startswith(b"\x89PNG")
