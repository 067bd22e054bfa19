"""Exported programs of lights agree with Python."""

import numpy as np
import pytest

from tests.extras.export import run_program
from uplift.extras.emission.discs import MIN_RADIUS
from uplift.extras.emission.lookup import load_emission
from uplift.extras.export.light_program import write_light_program
from uplift.extras.export.program import LANGUAGES

WAVELENGTHS = [300.0, 455.0, 551.5, 790.0]
WITHIN = 3e-4  # tolerance of single precision as a share of the largest power
# The function that programs of cubes have.
ALIAS = "\n#define cube_reflectances cube_power\n"


@pytest.fixture(scope="module")
def table():
    return load_emission()


@pytest.fixture(scope="module")
def colours(table):
    """Linear RGB (6000, 3): bright ones, negative ones, those that no light has, NaN,
    and around lamps.
    """
    rng = np.random.default_rng(3)
    rgb = rng.random((6000, 3)) * np.exp(4 * rng.normal(size=(6000, 1)))
    rgb[2000:4000] = rng.normal(size=(2000, 3)) + 0.5
    entries = table.data.entries
    lamps = table.rgb(entries.spectra[entries.radius >= MIN_RADIUS])
    rgb[4000:] = np.resize(lamps, (2000, 3)) * (
        1 + np.repeat([0, 0.003, 0.03, 0.1], 500)[:, None]
    )
    rgb[5000:] += 0.01 * rng.normal(size=(1000, 3))
    rgb[:3] = [[0, 0, 0], [1, 1, 1], [-1, -1, -1]]
    rgb[3:5] = [[np.nan, 1, 0.5], [1, np.inf, -np.inf]]
    return rgb.astype(np.float32).astype(float)


@pytest.mark.parametrize(
    ("style", "form"), [("c", "file"), ("fast", "header"), ("glsl", "file")]
)
def test_six_thousand_colours_equal_those_of_python(
    table, colours, tmp_path, style, form
):
    """NaN and infinity are 0."""
    language = "glsl" if style == "glsl" else "c"
    path = tmp_path / f"cube{LANGUAGES[language].suffix}"
    write_light_program(table.data, path, style=language, form=form)
    path.write_text(path.read_text() + ALIAS)
    found = getattr(run_program, style)(path, colours, WAVELENGTHS, form)
    rgb = np.nan_to_num(colours, posinf=0, neginf=0)
    size = table.spectrum(rgb, outside="clip").max(axis=1, keepdims=True)
    expected = table.spectrum(rgb, np.clip(WAVELENGTHS, 380, 780), outside="clip")
    assert (np.abs(found - expected) / np.maximum(size, 1e-6)).max() < WITHIN
