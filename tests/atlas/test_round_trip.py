"""Round trips through both formats keep every bit."""

from __future__ import annotations

import os
import tempfile

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from uplift.atlas import Atlas, Entry, read_atlas, write_atlas

NAMES = st.text(st.characters(codec="utf-8", exclude_categories=["Cc", "Zl", "Zp"]), min_size=1, max_size=20)
TEXTS = st.text('ab" :{}-', max_size=12).map(lambda text: " ".join(text.split()))
REFLECTANCES = st.floats(-0.05, 2.0)
INNER = st.floats(1.0, 2000.0).map(lambda nm: round(nm, 4))


@st.composite
def samplings(draw):
    """Irregular wavelengths, or regular ones with any start and step that cover the visible range."""
    if draw(st.booleans()):
        return np.unique([400.0, 700.0, *draw(st.lists(INNER, max_size=8))])
    start, step = draw(st.floats(300.0, 400.0)), draw(st.floats(5.0, 100.0))
    return start + step * np.arange(int(np.ceil((701.0 - start) / step)) + 1)


@st.composite
def atlases(draw, one_sampling):
    shared = draw(samplings())
    names = draw(st.lists(NAMES.map(str.strip).filter(bool), min_size=1, max_size=4, unique=True))
    entries = []
    for name in names:
        wavelengths = shared if one_sampling else draw(samplings())
        values = draw(st.lists(REFLECTANCES, min_size=len(wavelengths), max_size=len(wavelengths)))
        entries.append(Entry(name, wavelengths, np.array(values), *(draw(TEXTS) for _ in range(5))))
    return Atlas(tuple(entries))


def round_trip(spectra, name):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, name)
        write_atlas(spectra, path)
        return read_atlas(path)


def check_same(found, spectra):
    assert found.names == spectra.names
    for one, other in zip(found.entries, spectra.entries, strict=True):
        assert one.wavelengths.tobytes() == other.wavelengths.tobytes()
        assert one.values.tobytes() == other.values.tobytes()


@settings(max_examples=60)
@given(atlases(one_sampling=False))
def test_text(spectra):
    found = round_trip(spectra, "atlas.txt")
    check_same(found, spectra)
    for one, other in zip(found.entries, spectra.entries, strict=True):
        for key in ("description", "additional_description", "device", "measured_by", "date"):
            assert getattr(one, key) == getattr(other, key)


@settings(max_examples=60)
@given(atlases(one_sampling=True))
def test_csv(spectra):
    check_same(round_trip(spectra, "atlas.csv"), spectra)


def test_quoted_hash_is_a_name_and_not_a_comment(tmp_path):
    path = tmp_path / "atlas.csv"
    path.write_text('# a comment\n"name",400,700\n  # another\n"#",0.1,0.2\n"# 1",0.3,0.4\n')
    assert [entry.name for entry in read_atlas(path)] == ["#", "# 1"]
