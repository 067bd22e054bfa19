"""Sensors of cameras: sensitivities by name and from files, and the matrix of a camera
that is a linear map of XYZ.
"""

import json

import colour
import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.colorimetry.camera import CAMERA, Camera
from uplift.common.errors import ColourError, OptionError, UnknownNameError
from uplift.extras.colour.camera_file import read_camera
from uplift.extras.colour.spaces import find_space

NIKON = "Nikon 5100 (NPL)"
SIGMA = "Sigma SDMerill (NPL)"
TABLE = "# made by hand\nnm,R,G,B\n400,0,0,2\n500,0,4,1\n\n600,2,1,0\n700,1,0,0\n"


def write(folder, text):
    path = folder / "mine.csv"
    path.write_text(text)
    return path


@pytest.mark.parametrize(("camera", "illuminant"), [(NIKON, "A"), (SIGMA, "D65")])
def test_raw_values_are_sums_of_sensitivities_balanced_to_white(camera, illuminant):
    sensor = observer.sensor(CAMERA, illuminant, camera)
    reflectance = np.random.default_rng(1).random(81)
    power = (
        colour.SDS_ILLUMINANTS[illuminant]
        .copy()
        .align(colour.SpectralShape(380, 780, 5))
        .values
    )
    table = colour.MSDS_CAMERA_SENSITIVITIES[camera]  # every 5 or 10 nm
    given = {
        float(nm): row for nm, row in zip(table.wavelengths, table.values, strict=True)
    }
    raw = np.zeros(3)
    white = np.zeros(3)
    for nm, light, value in zip(range(380, 781, 5), power, reflectance, strict=True):
        near = [
            given[float(each)]
            for each in (nm - nm % 10, nm + -nm % 10)
            if float(each) in given
        ]
        row = given.get(
            float(nm), np.mean(near, axis=0) if len(near) == 2 else np.zeros(3)
        )
        raw = raw + light * value * row
        white = white + light * row
    assert_allclose(sensor.rgb(reflectance), raw / white, rtol=1e-12)
    assert (sensor.space, sensor.observer) == (camera, observer.DEFAULT_OBSERVER)
    wide = observer.on_range(sensor, 360.0, 830.0, 1.0)
    assert_allclose(wide.rgb(np.ones(471)), 1, rtol=1e-12)
    assert (wide.sensitivities[wide.wavelengths < 380] == 0).all()


def test_the_matrix_of_a_camera_that_sees_as_the_observer_is_known():
    mixed = np.array([[0.9, 0.1, 0.02], [0.05, 0.8, 0.1], [0.01, 0.05, 0.95]])
    sensor = observer.sensor(
        CAMERA,
        "A",
        Camera("luther", observer.grid(), observer.matching_functions() @ mixed.T),
    )
    expected = mixed / (mixed @ sensor.light.white)[:, None]
    assert_allclose(sensor.xyz_to_rgb, expected, rtol=1e-9, atol=1e-12)
    reflectance = np.random.default_rng(2).random((5, 81))
    assert_allclose(
        sensor.xyz(sensor.rgb(reflectance)), reflectance @ sensor.light.xyz.T, rtol=1e-9
    )


def test_a_file_is_read(tmp_path):
    camera = read_camera(write(tmp_path, TABLE))
    assert (camera.name, camera.wavelengths.tolist()) == ("mine", [400, 500, 600, 700])
    assert camera.sensitivities.tolist() == [
        [0, 0, 0.5],
        [0, 1, 0.25],
        [0.5, 0.25, 0],
        [0.25, 0, 0],
    ]
    assert camera.at([399, 450, 701]).tolist() == [
        [0, 0, 0],
        [0, 0.5, 0.375],
        [0, 0, 0],
    ]
    assert observer.sensor(CAMERA, observer=str(tmp_path / "mine.csv")).space == "mine"


@pytest.mark.parametrize(
    "text",
    [
        "Canon 5D\nnm;R;G;B\n400;0;0;2\n500;0;4;1\n600;2;1;0\n700;0,5;0;0\n",
        "\ufeffnm\tR\tG\tB\n400\t0\t0\t2\n500\t0\t4\t1\n600\t2\t1\t0\n700\t0,5\t0\t0\n",
        "400 0 0 2\n500  0 4 1\n600 2 1 0\n700 0,5 0 0\n",
        '"400","0","0","2"\n"500","0","4","1"\n"600","2","1","0"\n"700","0,5","0","0"\n',
        "700, 0.5, 0, 0,\n600, 2, 1, 0,\n500, 0, 4, 1,\n400, 0, 0, 2,\n,,,,\n",
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_tables_of_any_spreadsheet(tmp_path, text, encoding):
    path = tmp_path / "mine.txt"
    path.write_text(text, encoding=encoding)
    camera = read_camera(path)
    assert camera.wavelengths.tolist() == [400, 500, 600, 700]
    assert camera.sensitivities.tolist() == [
        [0, 0, 0.5],
        [0, 1, 0.25],
        [0.5, 0.25, 0],
        [0.125, 0, 0],
    ]


ROWS = {"400": [0, 0, 2], "500": [0, 4, 1], "600": [2, 1, 0]}


def json_of(labels, rows):
    return {
        "header": {"model": "x"},
        "spectral_data": {"index": {"main": labels}, "data": {"main": rows}},
    }


@pytest.mark.parametrize(
    "table",
    [
        json_of(["R", "G", "B"], ROWS),
        json_of(["B", "G", "R"], {nm: row[::-1] for nm, row in reversed(ROWS.items())}),
        {
            "maker": "x",
            "model": "y",
            "range": [400, 600, 100],
            "sensitivity": list(ROWS.values()),
        },
    ],
)
def test_json_of_rawtoaces(tmp_path, table):
    path = tmp_path / "mine.json"
    path.write_text(json.dumps(table))
    camera = observer.find_camera(str(path))
    assert (camera.name, camera.wavelengths.tolist()) == ("mine", [400, 500, 600])
    assert camera.sensitivities.tolist() == [[0, 0, 0.5], [0, 1, 0.25], [0.5, 0.25, 0]]


@pytest.mark.parametrize(
    "table",
    [
        [],
        {},
        {"spectral_data": {}},
        {"spectral_data": {"index": [], "data": []}},
        json_of(["X", "Y", "Z"], ROWS),
        json_of(["R", "G", "B"], {**ROWS, "700": [1, 2]}),
        json_of(["R", "G", "B"], {**ROWS, "red": [1, 2, 3]}),
        json_of(["R", "G", "B"], {"400": [1, 2, "x"]}),
        json_of(["R", "G", "B"], {}),
        {"range": [400, 700, 5], "sensitivity": list(ROWS.values())},
        {"range": [400, 600], "sensitivity": list(ROWS.values())},
        {"range": [400, 600, 100], "sensitivity": [1, 2]},
        {"range": [400, 600, 100], "sensitivity": []},
    ],
)
def test_bad_json(tmp_path, table):
    path = tmp_path / "bad.json"
    path.write_text(json.dumps(table))
    with raises(OptionError, "option") as caught:
        read_camera(path)
    assert caught.value.path == path


def test_a_file_of_another_suffix_is_named_as_a_file(tmp_path):
    path = tmp_path / "mine.xyz"
    path.write_text(TABLE)
    for space in (CAMERA, "sRGB"):
        with raises(UnknownNameError, "unknown-name") as caught:
            observer.sensor(space, observer=str(path))
        assert ".json" in caught.value.hint


@pytest.mark.parametrize(
    "rows",
    [
        "",
        "400,1,,2,3\n700,1,2,3\n",
        "400,0,1,0,2,0,3\n700,0,3,0,2,0,1\n",
        "400,1,2,3,4\n700,1,2,3,4\n",
        "400,1,2,3\n700,2,3,1\n500,3,1,2\n",
        "400,1,1,1\n",
        "400,1,nan,1\n700,1,1,1\n",
        "700,1,1,1\n400,1,1,1\n",
        "400,1,1,1\nred,green,blue,nm\n",
        "900,1,1,1\n1000,1,1,1\n",
        "400,1,1,1\n700,1,1,1\n",
        "400,1,0,1\n700,0,1,1\n",
    ],
)
def test_bad_sensitivities(tmp_path, rows):
    for header in ("", "wavelength,red,green,blue\n"):
        with raises(OptionError, "option"):
            observer.sensor(CAMERA, observer=str(write(tmp_path, header + rows)))


def test_a_camera_and_its_space_require_each_other():
    with raises(OptionError, "option"):
        observer.sensor("sRGB", observer=NIKON)
    with raises(UnknownNameError, "unknown-name"):
        observer.sensor(CAMERA)
    nikon = observer.find_camera(NIKON)
    with raises(OptionError, "option"):
        observer.sensor(
            CAMERA, observer=Camera("sRGB", nikon.wavelengths, nikon.sensitivities)
        )
    with raises(OptionError, "file-not-found"):
        observer.sensor(CAMERA, observer="missing.csv")


def test_raw_values_are_not_converted():
    sensor = observer.sensor(CAMERA, observer=NIKON)
    space = find_space("sRGB")
    assert not space.agrees_with(sensor, encoded=False)
    with raises(ColourError, "camera-without-xyz"):
        space.matrix_to(sensor)
