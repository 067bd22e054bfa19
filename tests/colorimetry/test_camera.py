"""Sensors of cameras: sensitivities by name and from files, and the matrix of a camera that is a linear map of XYZ."""

import colour
import numpy as np
import pytest

from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.colorimetry.camera import CAMERA, Camera, read_camera
from uplift.colorimetry.spaces import find_space
from uplift.common.errors import ColourError, OptionError, UnknownNameError

NIKON, SIGMA = "Nikon 5100 (NPL)", "Sigma SDMerill (NPL)"
TABLE = "# made by hand\nnm,R,G,B\n400,0,0,2\n500,0,4,1\n\n600,2,1,0\n700,1,0,0\n"


def write(folder, text):
    path = folder / "mine.csv"
    path.write_text(text)
    return path


@pytest.mark.parametrize(("camera", "illuminant"), [(NIKON, "A"), (SIGMA, "D65")])
def test_raw_values_are_sums_of_sensitivities_balanced_to_white(camera, illuminant):
    sensor, reflectance = observer.sensor(CAMERA, illuminant, camera), np.random.default_rng(1).random(81)
    power = colour.SDS_ILLUMINANTS[illuminant].copy().align(colour.SpectralShape(380, 780, 5)).values
    table = colour.MSDS_CAMERA_SENSITIVITIES[camera]  # every 5 or 10 nm
    given = {float(nm): row for nm, row in zip(table.wavelengths, table.values, strict=True)}
    raw, white = np.zeros(3), np.zeros(3)
    for nm, light, value in zip(range(380, 781, 5), power, reflectance, strict=True):
        near = [given[float(each)] for each in (nm - nm % 10, nm + -nm % 10) if float(each) in given]
        row = given.get(float(nm), np.mean(near, axis=0) if len(near) == 2 else np.zeros(3))
        raw, white = raw + light * value * row, white + light * row
    np.testing.assert_allclose(sensor.rgb(reflectance), raw / white, rtol=1e-12)
    assert (sensor.space, sensor.observer) == (camera, observer.DEFAULT_OBSERVER)
    wide = observer.on_range(sensor, 360.0, 830.0, 1.0)
    np.testing.assert_allclose(wide.rgb(np.ones(471)), 1, rtol=1e-12)
    assert (wide.sensitivities[wide.wavelengths < 380] == 0).all()


def test_the_matrix_of_a_camera_that_sees_as_the_observer_is_known():
    mixed = np.array([[0.9, 0.1, 0.02], [0.05, 0.8, 0.1], [0.01, 0.05, 0.95]])
    sensor = observer.sensor(CAMERA, "A", Camera("luther", observer.grid(), observer.matching_functions() @ mixed.T))
    expected = mixed / (mixed @ sensor.light.white)[:, None]
    np.testing.assert_allclose(sensor.xyz_to_rgb, expected, rtol=1e-9, atol=1e-12)
    reflectance = np.random.default_rng(2).random((5, 81))
    np.testing.assert_allclose(sensor.xyz(sensor.rgb(reflectance)), reflectance @ sensor.light.xyz.T, rtol=1e-9)


def test_a_file_is_read(tmp_path):
    camera = read_camera(write(tmp_path, TABLE))
    assert (camera.name, camera.wavelengths.tolist()) == ("mine", [400, 500, 600, 700])
    assert camera.sensitivities.tolist() == [[0, 0, 0.5], [0, 1, 0.25], [0.5, 0.25, 0], [0.25, 0, 0]]
    assert camera.at([399, 450, 701]).tolist() == [[0, 0, 0], [0, 0.5, 0.375], [0, 0, 0]]
    assert observer.sensor(CAMERA, observer=str(tmp_path / "mine.csv")).space == "mine"


@pytest.mark.parametrize(
    "rows",
    [
        "",
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
        observer.sensor(CAMERA, observer=Camera("sRGB", nikon.wavelengths, nikon.sensitivities))
    with raises(OptionError, "file-not-found"):
        observer.sensor(CAMERA, observer="missing.csv")


def test_raw_values_are_not_converted():
    sensor, space = observer.sensor(CAMERA, observer=NIKON), find_space("sRGB")
    assert not space.agrees_with(sensor, encoded=False)
    with raises(ColourError, "camera-without-xyz"):
        space.matrix_to(sensor)
