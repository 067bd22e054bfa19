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
from uplift.common.errors import ColourError, UpliftError
from uplift.extras.colour.camera_file import read_camera
from uplift.extras.colour.spaces import find_space

NIKON = "Nikon 5100 (NPL)"
SIGMA = "Sigma SDMerill (NPL)"
SHAPE = colour.SpectralShape(380, 780, 5)


@pytest.mark.parametrize(("camera", "illuminant"), [(NIKON, "A"), (SIGMA, "D65")])
def test_raw_values_are_sums_of_sensitivities_balanced_to_white(camera, illuminant):
    sensor = observer.sensor(CAMERA, illuminant, camera)
    reflectance = np.random.default_rng(1).random(81)
    light = colour.SDS_ILLUMINANTS[illuminant].copy().align(SHAPE).values
    table = colour.MSDS_CAMERA_SENSITIVITIES[camera]  # every 5 or 10 nm
    at = SHAPE.wavelengths
    sensitivities = np.stack(
        [
            np.interp(at, table.wavelengths, column, left=0, right=0)
            for column in table.values.T
        ]
    )
    raw = sensitivities @ (light * reflectance)
    white = sensitivities @ light
    assert_allclose(sensor.rgb(reflectance), raw / white, rtol=1e-12)
    assert (sensor.space, sensor.observer) == (camera, observer.DEFAULT_OBSERVER)


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


TABLE = """\
# made by hand
nm,R,G,B
400,0,0,2
500,0,4,1

600,2,1,0
700,0.5,0,0
"""
ROWS = {"400": [0, 0, 2], "500": [0, 4, 1], "600": [2, 1, 0], "700": [0.5, 0, 0]}


def json_of(labels, rows):
    """A file of rawtoaces."""
    data = {"index": {"main": labels}, "data": {"main": rows}}
    return json.dumps({"header": {"model": "x"}, "spectral_data": data})


def sampled(limits, rows):
    return json.dumps({"maker": "x", "range": limits, "sensitivity": rows})


REVERSED = {nm: row[::-1] for nm, row in reversed(ROWS.items())}
SEMICOLONS = "Canon 5D\n" + TABLE[15:].replace(",", ";").replace(".", ",")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("mine.csv", TABLE),
        ("mine.csv", SEMICOLONS),
        ("mine.txt", "\ufeff" + TABLE.replace(",", "\t")),
        ("mine.txt", TABLE[24:].replace(",", "  ")),
        ("mine.csv", "700, 0.5, 0, 0,\n600,2,1,0,\n500,0,4,1,\n400,0,0,2,\n,,,,\n"),
        ("mine.json", json_of(["R", "G", "B"], ROWS)),
        ("mine.json", json_of(["B", "G", "R"], REVERSED)),
        ("mine.json", sampled([400, 700, 100], list(ROWS.values()))),
    ],
)
def test_files_of_cameras_are_read(tmp_path, name, text):
    path = tmp_path / name
    for encoding in ("utf-8", "utf-16")[: 1 if path.suffix == ".json" else 2]:
        path.write_text(text, encoding=encoding)
        camera = read_camera(path)
        assert camera.name == "mine"
        assert camera.wavelengths.tolist() == [400, 500, 600, 700]
        assert (4 * camera.sensitivities).tolist() == [
            [0, 0, 2],
            [0, 4, 1],
            [2, 1, 0],
            [0.5, 0, 0],
        ]
    at = camera.at([399, 450, 701]).tolist()
    assert at == [[0, 0, 0], [0, 0.5, 0.375], [0, 0, 0]]
    assert observer.sensor(CAMERA, observer=str(path)).space == "mine"


BAD_JSON = (
    "[]",
    '{"spectral_data": {"index": [], "data": []}}',
    json_of(["X", "Y", "Z"], ROWS),
    json_of(["R", "G", "B"], {**ROWS, "700": [1, 2]}),
    json_of(["R", "G", "B"], {**ROWS, "red": [1, 2, 3]}),
    json_of(["R", "G", "B"], {}),
    sampled([400, 700, 5], list(ROWS.values())),
    sampled([400, 600], list(ROWS.values())),
    sampled([400, 600, 100], [1, 2]),
)
BAD_ROWS = (
    "",
    "400,1,,2,3\n700,1,2,3\n",
    "400,1,2,3,4\n700,1,2,3,4\n",
    "400,1,2,3\n700,2,3,1\n500,3,1,2\n",
    "400,1,1,1\n",
    "400,1,nan,1\n700,1,1,1\n",
    "900,1,1,1\n1000,1,1,1\n",
    "400,1,1,1\n700,1,1,1\n",
    "400,1,0,1\n700,0,1,1\n",
)
HEADER = "wavelength,red,green,blue\n"


@pytest.mark.parametrize(
    ("name", "text", "code"),
    [
        *(("bad.json", text, "option") for text in BAD_JSON),
        *(("bad.csv", rows, "option") for rows in BAD_ROWS),
        *(("bad.csv", HEADER + rows, "option") for rows in BAD_ROWS),
        ("bad.xyz", TABLE, "unknown-name"),
    ],
)
def test_bad_files_of_cameras_raise(tmp_path, name, text, code):
    path = tmp_path / name
    path.write_text(text)
    with raises(UpliftError, code):
        observer.sensor(CAMERA, observer=str(path))


def test_a_camera_and_its_space_require_each_other():
    nikon = observer.find_camera(NIKON)
    named_as_a_space = Camera("sRGB", nikon.wavelengths, nikon.sensitivities)
    for space, camera, code in (
        ("sRGB", NIKON, "option"),
        (CAMERA, observer.DEFAULT_OBSERVER, "unknown-name"),
        (CAMERA, named_as_a_space, "option"),
        (CAMERA, "missing.csv", "file-not-found"),
    ):
        with raises(UpliftError, code):
            observer.sensor(space, observer=camera)


def test_raw_values_are_not_converted():
    sensor = observer.sensor(CAMERA, observer=NIKON)
    space = find_space("sRGB")
    assert not space.agrees_with(sensor, encoded=False)
    with raises(ColourError, "camera-without-xyz"):
        space.matrix_to(sensor)
