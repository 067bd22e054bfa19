"""Files of emission tables: round trip, damage, and content that is refused although
its digest is valid.
"""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import uplift
from tests.helpers import raises
from uplift.common.errors import CubeFileError, OutputError
from uplift.cube import container
from uplift.extras.emission import file as table
from uplift.extras.emission.file import emission_digest, read_emission, write_emission


@pytest.fixture(scope="module")
def data():
    return uplift.load_emission().data


def forge(data, path, change):
    """Write ``data`` after ``change(tensors, metadata)``, with the digest of the
    changed content.
    """
    tensors = table._tensors(data)
    metadata = table._metadata(data)
    change(tensors, metadata)
    container.save((tensors, metadata), path, table.KIND, lambda _: None, force=True)
    return path


def test_round_trip_is_exact(tmp_path, data):
    write_emission(data, tmp_path / "a.uplift")
    found = read_emission(tmp_path / "a.uplift")
    assert emission_digest(found) == emission_digest(data)
    assert_array_equal(found.spectra, data.spectra)
    assert found.entries.names == data.entries.names
    write_emission(found, tmp_path / "b.uplift")
    assert (tmp_path / "a.uplift").read_bytes() == (tmp_path / "b.uplift").read_bytes()


def spoil(name, value):
    """A change that replaces one element of an array."""

    def change(tensors, metadata):
        tensors[name] = tensors[name].copy()
        tensors[name].flat[-1] = value

    return change


@pytest.mark.parametrize(
    ("code", "change"),
    [
        ("cube-file", spoil("spectra", np.nan)),
        ("cube-file", spoil("entries.uv", 0.9)),
        ("cube-file", spoil("entries.radius", 0.05)),
        ("cube-file", lambda tensors, _: tensors.update(rgb_to_xyz=np.ones((3, 3)))),
        ("cube-file", spoil("rings", 0.5)),
        ("cube-file", lambda tensors, _: tensors.pop("error")),
        ("cube-file", lambda _, metadata: metadata.update(entries=["A"] * 5)),
        ("cube-version", lambda _, metadata: metadata.update(version=2)),
        ("cube-feature", lambda _, metadata: metadata.update(features=["polarised"])),
    ],
)
def test_invalid_content_is_refused(tmp_path, data, code, change):
    with raises(CubeFileError, code):
        read_emission(forge(data, tmp_path / "forged.uplift", change))


def test_an_unreadable_table_is_not_written(tmp_path, data):
    broken = replace(data, error=np.full_like(data.error, np.nan))
    with raises(OutputError, "output"):
        write_emission(broken, tmp_path / "table.uplift")
    assert not list(tmp_path.iterdir())
