"""The synthetic scan of an engine as an image of weights for the relighting viewer."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.dial import scan
from uplift.design.palette.picture import read_weights

SIDE = 90


@pytest.fixture(scope="module")
def weights():
    return scan.cast(scan.scan(90), SIDE)


def test_every_material_is_visible_and_no_pixel_reflects_more_than_it_gets(weights):
    assert weights.shape == (SIDE, SIDE, len(scan.DENSITIES))
    assert weights.min() >= 0
    assert weights.sum(axis=-1).max() <= 1
    assert (weights.max(axis=(0, 1)) > 0.02).all()
    assert not weights[0, 0].any()


def test_a_block_in_front_hides_what_is_behind():
    """With the scan turned back, rays run along z."""
    slab = np.zeros((24, 24, 24), dtype=np.float32)
    slab[:, :, 14:20] = scan.DENSITIES["block"]
    slab[:, :, 4:10] = scan.DENSITIES["valve"]
    names = list(scan.DENSITIES)
    front = scan._opacities(slab[:, :, 16])[0, 0]
    assert front[names.index("block")] == pytest.approx(scan.OPACITIES["block"])
    assert front[names.index("valve")] == 0
    middle = scan.cast(slab, 24)[12, 12]
    assert middle[names.index("block")] > 20 * middle[names.index("valve")]


def test_the_viewer_reads_the_weights(weights, tmp_path):
    path = tmp_path / "engine.exr"
    scan.write_weights(weights, path)
    order = ["block", "haze", "piston", "valve"]
    found = read_weights(path, order, {})
    np.testing.assert_allclose(found, weights[..., [list(scan.DENSITIES).index(name) for name in order]], atol=1e-6)
