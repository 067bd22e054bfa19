"""Cubes of cameras: built, stored, read, queried and rebuilt."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.cube.cube_files import forge
from tests.fuzz.builds import little_work
from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.colorimetry.camera import CAMERA
from uplift.common.errors import CubeFileError
from uplift.cube.file import digest
from uplift.extras.report.rebuild import rebuild

NIKON = "Nikon 5100 (NPL)"
GREYS = np.array([[0.2, 0.2, 0.2], [0.5, 0.48, 0.45]])


@pytest.fixture(scope="module", autouse=True)
def _little_work():
    with little_work():
        yield


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    """The sensitivities of a shipped camera as a file."""
    camera = observer.find_camera(NIKON)
    rows = np.column_stack([camera.wavelengths, camera.sensitivities]).tolist()
    path = tmp_path_factory.mktemp("camera") / "lens.csv"
    path.write_text(
        "nm,r,g,b\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows)
    )
    return path


@pytest.fixture(scope="module")
def cube(table):
    """Dim 4 of the camera of the file, under A."""
    sensor = {"space": CAMERA, "observer": str(table), "illuminant": "A"}
    return uplift.build(dim=4, coefficients=5, prior="smooth", **sensor)


def test_a_stored_cube_is_read_and_rebuilt_without_its_file(cube, table, tmp_path):
    path = tmp_path / "camera.uplift"
    cube.save(path)
    stored = uplift.load(path)
    assert (stored.space, stored.observer) == ("lens", observer.DEFAULT_OBSERVER)
    options = stored.data.provenance["options"]
    assert (options["space"], options["observer"]) == (CAMERA, "lens")
    assert digest(stored.data) == digest(cube.data)
    assert digest(rebuild(stored, path).data) == digest(cube.data)
    raw = stored.data.sensor.rgb(stored.reflectance(GREYS))
    assert_allclose(raw, GREYS, atol=1e-4)


@pytest.mark.parametrize(
    ("name", "factors"),
    [("sensitivities", [1, 0, 1]), ("cmfs", [1, 0, 1]), ("cmfs", [0, 0, 0])],
)
def test_forged_channels_that_depend_on_each_other_are_refused(
    cube, tmp_path, name, factors
):
    def forged(tensors, metadata):
        tensors[f"sensor.{name}"] = factors * tensors[f"sensor.{name}"]

    with raises(CubeFileError, "cube-file"):
        uplift.load(forge(cube.data, tmp_path / "forged.uplift", forged))
