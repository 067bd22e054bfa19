"""Bad input to exports: an error, and no file."""

from dataclasses import replace

import pytest

from uplift.colorimetry.observer import sensor
from uplift.common.errors import OptionError, OutputError, UnknownNameError
from uplift.extras.emission.lookup import load_emission
from uplift.extras.export.coeff import write_coeff
from uplift.extras.export.film import write_film
from uplift.extras.export.light_program import write_light_program
from uplift.extras.export.lut import write_lut
from uplift.extras.export.program import write_program


@pytest.fixture(scope="module")
def cubes(small_cube):
    """Cubes, data and tables by name."""
    wide = replace(small_cube.data, sensor=sensor("ACEScg", "D60"))
    return {
        "cube": small_cube,
        "data": small_cube.data,
        "wide": wide,
        "lights": load_emission().data,
    }


@pytest.mark.parametrize(
    ("write", "source", "name", "options", "error"),
    [
        (write_coeff, "data", "a.coeff", {"res": 1}, OptionError),
        (write_coeff, "data", "a.coeff", {"res": 257}, OptionError),
        (write_coeff, "wide", "a.cpp", {"layout": "pbrt", "res": 2}, OptionError),
        (write_coeff, "wide", "a.cpp", {"layout": "luisa", "res": 2}, OptionError),
        (write_film, "cube", "a.npy", {"res": 1}, OptionError),
        (write_film, "cube", "a.npy", {"light": "moonlight"}, UnknownNameError),
        (write_film, "cube", "a.npy", {"res": 4}, OutputError),
        (
            write_light_program,
            "lights",
            "a.h",
            {"style": "glsl", "form": "header"},
            OptionError,
        ),
        (write_lut, "cube", "a.cube", {"light": "HP1", "res": 1}, OptionError),
        (write_lut, "cube", "a.cube", {"light": "moonlight"}, UnknownNameError),
        (write_program, "data", "a.h", {"form": "textures"}, OptionError),
        (
            write_program,
            "data",
            "a.h",
            {"style": "glsl", "form": "header"},
            OptionError,
        ),
    ],
)
def test_bad_input_writes_nothing(cubes, tmp_path, write, source, name, options, error):
    if error is OutputError:  # the file that goes with it exists
        (tmp_path / "a.toml").touch()
    with pytest.raises(error):
        write(cubes[source], path=tmp_path / name, **options)
    assert [each.name for each in tmp_path.iterdir()] == ["a.toml"] * (
        error is OutputError
    )
