"""Programs of pages whose computations nothing else tests: matrices of cameras, closed
cells.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from benchmarks.cameras import lab_matrix, xyz_matrix
from benchmarks.representations import closed, enhanced, with_tables_6
from uplift.extras.papers.representations.samples import xyz_weights


def test_known_camera_matrices_are_found_and_keep_white():
    known = np.array([[0.6, 0.3, 0.1], [0.3, 0.6, 0.1], [0.05, 0.1, 0.85]])
    rng = np.random.default_rng(4)
    raw = rng.random((12, 3))
    assert_allclose(xyz_matrix(raw, raw @ known.T), known, rtol=1e-10)
    assert_allclose(lab_matrix(raw, raw @ known.T), known, rtol=1e-6)
    noisy = raw @ known.T + 0.01 * rng.standard_normal((12, 3))
    assert_allclose(lab_matrix(raw, noisy).sum(axis=1), 1, rtol=1e-12)


@pytest.mark.parametrize("count", [8, 32])
def test_closed_cells_keep_the_white(count):
    for one in (closed(count), enhanced(count)):
        white = one.xyz(one.encode_light(np.ones((1, 401))))
        assert_allclose(white[0], xyz_weights().sum(axis=0), rtol=2e-3)


def test_thesis_tables_have_the_printed_values():
    row = {"lights": "spiky", "representation": "CS15"}
    other = row | {"representation": "TM9"}
    of_thesis = {"thesis_mean": 0.316, "thesis_q97_5": 0.816}
    expected = [row | of_thesis, other | dict.fromkeys(of_thesis)]
    assert with_tables_6([row, other]) == expected
