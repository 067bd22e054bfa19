"""Atlases from distributions of other libraries."""

from __future__ import annotations

from types import SimpleNamespace

import colour
import numpy as np
import pytest

from tests.helpers import raises
from uplift.atlas import from_distributions, read_atlas, write_atlas
from uplift.common.errors import AtlasError

NM = np.array([400.0, 550.0, 700.0])
RED = SimpleNamespace(name="red", wavelengths=NM, values=np.array([0.1, 0.2, 0.9]))


def test_mapping_of_colour_science(tmp_path):
    checker = colour.SDS_COLOURCHECKERS["ColorChecker N Ohta"]
    spectra = from_distributions(checker)
    assert spectra.names == tuple(checker)
    np.testing.assert_array_equal(spectra.entries[6].values, checker["orange"].values)
    write_atlas(spectra, tmp_path / "out.txt")
    assert read_atlas(tmp_path / "out.txt").sources[0].digest == spectra.sources[0].digest


def test_several_distributions_of_colour_science():
    several = colour.MultiSpectralDistributions(
        np.array([[0.1, 0.8], [0.2, 0.3], [0.9, 0.05]]), NM, labels=["red", "blue"]
    )
    spectra = from_distributions(several)
    assert spectra.names == ("red", "blue")
    assert spectra.entries[1].values.tolist() == [0.8, 0.3, 0.05]


def test_any_class_with_the_attributes():
    assert from_distributions({"a": RED, 2: RED}).names == ("a", "2")
    assert from_distributions(RED).names == ("red",)
    assert from_distributions({}).names == ()


@pytest.mark.parametrize(
    ("distributions", "entry", "code"),
    [
        (3, "int", "atlas"),
        ({"a": [1, 2]}, "a", "atlas"),
        (SimpleNamespace(labels=["a"], wavelengths=NM, values=NM), None, "atlas"),
        ({"a": SimpleNamespace(wavelengths=NM, values=NM)}, "a", "atlas"),
    ],
)
def test_invalid_distributions_raise(distributions, entry, code):
    with raises(AtlasError, code) as caught:
        from_distributions(distributions)
    assert caught.value.entry == entry
