"""Matrices of cameras, and printed values of a thesis, as pages have them."""

import numpy as np
from numpy.testing import assert_allclose

from benchmarks.cameras import lab_matrix, xyz_matrix
from benchmarks.representations import with_tables_6


def test_known_camera_matrices_are_found_and_keep_white():
    known = np.array([[0.6, 0.3, 0.1], [0.3, 0.6, 0.1], [0.05, 0.1, 0.85]])
    rng = np.random.default_rng(4)
    raw = rng.random((12, 3))
    assert_allclose(xyz_matrix(raw, raw @ known.T), known, rtol=1e-10)
    assert_allclose(lab_matrix(raw, raw @ known.T), known, rtol=1e-6)
    noisy = raw @ known.T + 0.01 * rng.standard_normal((12, 3))
    assert_allclose(lab_matrix(raw, noisy).sum(axis=1), 1, rtol=1e-12)


def test_thesis_tables_have_the_printed_values():
    row = {"lights": "spiky", "representation": "CS15"}
    other = row | {"representation": "TM9"}
    of_thesis = {"thesis_mean": 0.316, "thesis_q97_5": 0.816}
    expected = [row | of_thesis, other | dict.fromkeys(of_thesis)]
    assert with_tables_6([row, other]) == expected
