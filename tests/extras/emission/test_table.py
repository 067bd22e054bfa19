"""Files of emission tables: round trip, damage, and content that is refused although
its digest is valid.
"""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import uplift
from tests.helpers import raises
from uplift.common.errors import CubeFileError
from uplift.cube import container
from uplift.extras.emission import file as table
from uplift.extras.emission.file import emission_digest, read_emission, write_emission


@pytest.fixture(scope="module")
def data():
    return uplift.load_emission().data


def test_round_trip_is_exact(tmp_path, data):
    write_emission(data, tmp_path / "a.uplift")
    found = read_emission(tmp_path / "a.uplift")
    assert emission_digest(found) == emission_digest(data)
    assert_array_equal(found.spectra, data.spectra)
    assert found.entries.names == data.entries.names
    write_emission(found, tmp_path / "b.uplift")
    assert (tmp_path / "a.uplift").read_bytes() == (tmp_path / "b.uplift").read_bytes()


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("spectra", np.nan),
        ("entries.uv", 0.9),
        ("entries.radius", 0.05),
        ("rgb_to_xyz", 0.0),
        ("rings", 0.5),
    ],
)
def test_invalid_content_is_refused(tmp_path, data, name, value):
    """Though its digest is that of the changed content."""
    tensors = table._tensors(data)
    tensors[name] = tensors[name].copy()
    tensors[name][-1] = value
    path = tmp_path / "forged.uplift"
    content = (tensors, table._metadata(data))
    container.save(content, path, table.KIND, lambda _: None, force=True)
    with raises(CubeFileError, "cube-file"):
        read_emission(path)
