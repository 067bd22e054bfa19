"""Test sets: reproducible, and disjoint from the entries that build cubes."""

from __future__ import annotations

import numpy as np

from tests.helpers import raises
from uplift.atlas import Atlas, Entry, merge, on_grid, read_atlas
from uplift.common.errors import AtlasError, OptionError
from uplift.lab.chart.method import edges, make_task


def shipped(repository, *names):
    return {name: read_atlas(repository / "atlases" / f"{name}.txt") for name in names}


def test_every_second_entry_builds_and_the_others_test(repository):
    # The first atlas has an odd number of entries; counting starts again with each atlas.
    atlases = shipped(repository, "vs", "macbeth")
    found = make_task(atlases, 16)
    names = [entry.name for spectra in atlases.values() for entry in spectra.entries[::2]]
    assert list(found.kept.names) == names
    rows = {tuple(row) for row in found.own.round(12)}
    assert not rows & {tuple(row) for row in found.unseen.round(12)}
    every = on_grid(merge(atlases.values()), found.sensor.wavelengths)
    assert len(found.own) + len(found.unseen) == found.sensor.contains(found.sensor.rgb(every)).sum()


def test_task_is_reproducible(small_task, repository):
    again = make_task(shipped(repository, "macbeth"), 16)
    for name in ("rgb", "own", "unseen"):
        np.testing.assert_array_equal(getattr(again, name), getattr(small_task, name))


def test_edges_contain_every_corner_and_grey_once():
    found = edges()
    assert len(np.unique(found, axis=0)) == len(found)
    assert ((found == 0) | (found == 1) | (found == found[:, :1]).all(axis=1, keepdims=True)).any(axis=1).all()
    corners = found[((found == 0) | (found == 1)).all(axis=1)]
    assert len(corners) == 8
    assert (np.ptp(found, axis=1) == 0).sum() == 9


def test_too_few_colours_or_entries_are_an_error(repository):
    with raises(OptionError, "too-few-colours"):
        make_task(shipped(repository, "macbeth"), 15)
    at = np.arange(380.0, 781.0, 10.0)
    two = Atlas(tuple(Entry(name, at, np.full(len(at), 0.5)) for name in ("one", "other")))
    with raises(AtlasError, "too-few-entries"):
        make_task({"two": two}, 16)
