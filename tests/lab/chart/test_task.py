"""Colours and spectra of a chart."""

import numpy as np
from numpy.testing import assert_array_equal

from tests.helpers import raises
from uplift.atlas.atlas import Atlas, Entry, merge
from uplift.atlas.sources import read_atlas
from uplift.common.errors import AtlasError
from uplift.lab.chart.task import make_task
from uplift.lab.look_alikes import families_like
from uplift.lab.runner import spectra_of, within


def test_every_second_entry_is_known_and_the_others_test():
    # The first atlas has an odd number of entries; counting starts again with each
    # atlas.
    atlases = {name: read_atlas(name) for name in ("vs", "macbeth")}
    unseen = make_task(atlases).unseen
    vs, macbeth = atlases.values()
    assert unseen.known.names == vs.names[::2] + macbeth.names[::2]
    inside = within(merge(atlases.values()), unseen.sensor)
    spectra = spectra_of(inside, unseen.sensor)
    both = np.concatenate([unseen.known_spectra, unseen.queried])
    assert_array_equal(np.sort(both, axis=0), np.sort(spectra, axis=0))
    assert unseen.left_out == families_like(unseen.queried) != ()


def test_too_few_entries_are_an_error():
    greys = (Entry(name, [380, 780], [0.5, 0.5]) for name in ("one", "other"))
    with raises(AtlasError, "too-few-entries"):
        make_task({"two": Atlas(tuple(greys))})
