"""Low-pass filters and sampling-rate conversion."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.scene.representations.filters import Filter, resampling_matrix

SOME = [
    Filter("box", 5),
    Filter("tent", 7),
    Filter("welch", 9),
    Filter("gaussian", 7, (0.5,)),
    Filter("mitchell", 19, (-0.4, 1.0)),
    Filter("lanczos", 21, (2.5,)),
    Filter("hann", 9),
    Filter("hamming", 7),
]


def reference_conversion(taps, up, down, count, spectrum):
    """Conversion as in the listing of the thesis: insert zeros, filter, keep every M-th sample."""
    dense = np.zeros((len(spectrum) - 1) * up + 1)
    dense[::up] = spectrum
    smoothed = np.convolve(dense, taps * up, mode="full")[len(taps) // 2 :]
    return smoothed[: (count - 1) * down + 1 : down]


@pytest.mark.parametrize("low_pass", SOME, ids=lambda one: one.kind)
@pytest.mark.parametrize(("count", "up", "down"), [(4, 3, 80), (8, 7, 80), (16, 3, 16)])
def test_resampling_equals_the_listing_of_the_thesis(low_pass, count, up, down):
    spectrum = np.random.default_rng(8).random(81)
    expected = reference_conversion(low_pass.taps(up), up, down, count, spectrum)
    np.testing.assert_allclose(resampling_matrix(low_pass, count) @ spectrum, expected, atol=1e-12)


@pytest.mark.parametrize(
    ("low_pass", "formula"),
    [
        (Filter("tent", 9), lambda x: 1 - np.abs(x)),
        (Filter("welch", 9), lambda x: 1 - x**2),
        (Filter("gaussian", 9, (0.7,)), lambda x: np.exp(-0.7 * 4 * x**2) - np.exp(-0.7 * 4)),
        (Filter("hann", 9), lambda x: 0.5 + 0.5 * np.cos(np.pi * x)),
        (Filter("hamming", 9), lambda x: 0.54 + 0.46 * np.cos(np.pi * x)),
        (Filter("lanczos", 9, (2.0,)), lambda x: np.sinc(2 * x) * np.sinc(x)),
    ],
)
def test_windows_equal_the_formulas_of_the_thesis(low_pass, formula):
    taps = low_pass.taps(3)
    x = np.linspace(-1, 1, len(taps) + 2)[1:-1]
    np.testing.assert_allclose(taps, formula(x) / formula(x).sum(), atol=1e-12)


@pytest.mark.parametrize(("b", "c"), [(1 / 3, 1 / 3), (1, 0), (0, 0.5), (-0.4, 1)])
def test_pieces_of_the_mitchell_filter_meet_and_sum_to_one(b, c):
    taps = Filter("mitchell", 21, (b, c)).taps(31)
    scaled = taps / taps.sum() * len(taps) / 4
    assert np.abs(np.diff(scaled)).max() < 0.05 * (1 + abs(b) + abs(c))
    assert scaled[len(taps) // 2] == pytest.approx((6 - 2 * b) / 6, rel=0.02)
