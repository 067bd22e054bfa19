"""The sample of measured paints is what the invented paints give."""

import csv

import numpy as np
from numpy.testing import assert_allclose

from benchmarks.invented_paints import REMARK, SAMPLE, swatches_text


def numbers(text):
    rows = list(csv.reader(text.removeprefix(REMARK).splitlines()))
    labels = [row[:9] for row in rows]
    return labels, np.array([row[9:] for row in rows], dtype=float)


def test_the_sample_is_made_of_the_invented_paints():
    stored, measured = numbers(SAMPLE.read_text(encoding="utf-8"))
    labels, values = numbers(swatches_text())
    assert stored == labels
    assert_allclose(measured, values, atol=1.01e-4)
