"""`Atlas` as a sequence with names, entries from Python, distributions of other
libraries, and resampling.
"""

from types import SimpleNamespace

import colour
import numpy as np
import pytest
from numpy.testing import assert_array_equal

from tests.helpers import raises, warns
from uplift.atlas.atlas import Atlas, Entry, SkippedEntry, Source
from uplift.atlas.resampling import on_grid, resample
from uplift.atlas.sources import from_distributions, read_atlas, write_atlas
from uplift.common.errors import AtlasError, UnknownNameError

RED = Entry("red", [400, 550, 700], [0.0, 0.0, 1.0])
GREY = Entry("grey", [380, 780], [0.5, 0.5])
ATLAS = Atlas((RED, GREY), (SkippedEntry("lamp", "emits"),), (Source("a.txt", "00"),))
GRID = np.arange(380.0, 785.0, 5.0)
NM = np.array([400.0, 550.0, 700.0])


def test_an_atlas_is_a_sequence_with_names():
    assert (list(ATLAS), len(ATLAS)) == ([RED, GREY], 2)
    assert "red" in ATLAS
    assert "blue" not in ATLAS
    assert RED in ATLAS
    assert (ATLAS["grey"], ATLAS[0], ATLAS[-1]) == (GREY, RED, GREY)
    assert (ATLAS[1:].names, ATLAS[1:].sources) == (("grey",), ATLAS.sources)
    with raises(UnknownNameError, "unknown-name"):
        ATLAS["gray"]
    with pytest.raises(IndexError):
        ATLAS[2]


def test_distributions_of_colour_science(tmp_path):
    checker = colour.SDS_COLOURCHECKERS["ColorChecker N Ohta"]
    spectra = from_distributions(checker)
    assert spectra.names == tuple(checker)
    assert_array_equal(spectra["orange"].values, checker["orange"].values)
    write_atlas(spectra, tmp_path / "out.txt")
    assert (
        read_atlas(tmp_path / "out.txt").sources[0].digest == spectra.sources[0].digest
    )
    values = np.array([[0.1, 0.8], [0.2, 0.3], [0.9, 0.05]])
    several = from_distributions(
        colour.MultiSpectralDistributions(values, NM, labels=["red", "blue"])
    )
    assert several.names == ("red", "blue")
    assert several["blue"].values.tolist() == [0.8, 0.3, 0.05]


def distribution(wavelengths, values):
    return SimpleNamespace(wavelengths=wavelengths, values=values)


@pytest.mark.parametrize(
    ("distributions", "entry"),
    [
        (3, "int"),
        ({"a": [1, 2]}, "a"),
        (SimpleNamespace(labels=["a"], wavelengths=NM, values=NM), None),
        ({"a": distribution(NM, NM)}, "a"),
        ({"a": distribution([400, 700], [0.5])}, "a"),
        ({"a": distribution([400, None, 700], [1, 1, 1])}, "a"),
        ({"a\nb": distribution([400, 700], [1, 1])}, "a b"),
        ({"a\ud800": distribution([400, 700], [1, 1])}, "a\ud800"),
    ],
)
def test_invalid_distributions_raise(distributions, entry):
    with raises(AtlasError, "atlas") as caught:
        from_distributions(distributions)
    assert caught.value.entry == entry


def test_one_warning_for_all_clipped_entries():
    at = np.linspace(400, 700, 7)
    rows = ([0.5] * 6 + [1.25], [0.5] * 7, [1.5, 1.0, 0.5, -0.04, 0.5, 0.5, 0.5])
    spectra = Atlas([Entry(f"e{i}", at, row) for i, row in enumerate(rows)])
    with warns("entry-clipped") as caught:
        found = on_grid(spectra, GRID)
    assert "'e2' has 1.5 at 400 nm" in str(caught[0])
    assert (found.min(), found.max()) == (0.0, 1.0)
    assert [clip.name for clip in resample(spectra, GRID).clips] == ["e0", "e2"]
    noise = Entry("noise", at, [-2e-16, 0.5, 1 + 2e-16, 0.5, -9e-7, 0.5, 0.5])
    with warns():
        found = on_grid(Atlas([noise]), GRID)
    assert (found.min(), found.max()) == (0.0, 1.0)
