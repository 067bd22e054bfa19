"""Batches contain every row once, in two sizes; builds do not depend on the number of devices."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

from uplift import build, load
from uplift.fit.batch import CPU_BATCH_ROWS, batches, shard

LARGE, SMALL = CPU_BATCH_ROWS


@pytest.mark.parametrize(
    ("count", "smaller", "sizes"),
    [
        (0, 4, []),
        (1, 4, [SMALL]),
        (SMALL + 1, 4, [SMALL, SMALL]),
        (4 * SMALL, 4, [SMALL] * 4),
        (4 * SMALL + 1, 4, [LARGE]),
        (4 * SMALL + 1, 5, [SMALL] * 5),
        (LARGE, 4, [LARGE]),
        (2 * LARGE + 3, 4, [LARGE, LARGE, SMALL]),
    ],
)
def test_every_row_is_in_one_batch(count, smaller, sizes):
    rows = np.arange(count) + 7
    parts = list(batches(count, smaller))
    np.testing.assert_array_equal(np.concatenate([rows[:0], *(rows[part] for part, _ in parts)]), rows)
    assert [width for _, width in parts] == sizes
    for part, width in parts:
        padded = np.asarray(shard(rows[part], width))
        np.testing.assert_array_equal(padded[: len(rows[part])], rows[part])
        assert len(padded) == width
        assert set(padded[len(rows[part]) :]) <= {rows[part][-1]}


SEVERAL = """
import sys, jax, uplift
assert len(jax.devices()) == 3
uplift.build(sys.argv[1], dim=9).save(sys.argv[2])
"""


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
def test_several_devices_build_the_same_cube(repository, tmp_path):
    """Three simulated devices distribute the rows unevenly."""
    macbeth, path = repository / "atlases" / "macbeth.txt", tmp_path / "several.uplift"
    flags = {"XLA_FLAGS": "--xla_force_host_platform_device_count=3"}
    subprocess.run([sys.executable, "-W", "ignore", "-c", SEVERAL, macbeth, path], env=os.environ | flags, check=True)
    one, several = build(macbeth, dim=9).data, load(path).data
    np.testing.assert_allclose(several.points.coefficients, one.points.coefficients, rtol=0, atol=1e-9)
    np.testing.assert_allclose(several.points.standard_error, one.points.standard_error, rtol=1e-6)
    np.testing.assert_array_equal(several.points.status, one.points.status)
