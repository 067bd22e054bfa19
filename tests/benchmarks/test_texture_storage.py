"""Emulated storage of moments."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.textures import storage
from uplift.models import Moments

MOMENTS = Moments(9).to_storage(np.random.default_rng(1).normal(size=(8, 12, 9)))


@pytest.mark.parametrize("each", storage.STORAGES, ids=lambda each: each.name)
def test_decoded_moments_are_close(each):
    decoded = each.decode(each.encode(MOMENTS))
    within = 0.4 if each.bytes == 3 else 0.02
    np.testing.assert_allclose(decoded, MOMENTS, rtol=0, atol=within)


def test_steps_round_to_the_nearest():
    values = np.array([[[-1.0, 0.0, 0.26, 0.5, 1.0, 2.0]]])
    found = storage.steps(values, np.zeros(1), np.ones(1), 1)
    assert found.tolist() == [[[0, 0, 0, 0, 1, 1]]]


def test_a_warp_is_inverted():
    np.testing.assert_allclose(storage.unwarp(storage.warp(MOMENTS)), MOMENTS, rtol=0, atol=1e-12)


def test_blocks_keep_what_lies_on_a_line_in_sixteen_steps():
    ends = np.array([[0.0, 0.4, 1.0], [1.0, 0.6, 0.2]])
    share = np.linspace(0, 1, 16).reshape(4, 4, 1)
    block = (1 - share) * ends[0] + share * ends[1]
    found = storage.blocks(3, 10)(block)
    np.testing.assert_allclose(found, block, rtol=0, atol=2e-3)
    assert np.abs(storage.blocks(3, 10)(np.random.default_rng(0).random((4, 4, 3))) - block).max() > 0.1


def test_filters_take_means_of_four_texels():
    values = np.arange(16.0).reshape(4, 4, 1)
    assert storage.mip(values)[..., 0].tolist() == [[2.5, 4.5], [10.5, 12.5]]
    assert storage.bilinear(values).shape == (3, 3, 1)
