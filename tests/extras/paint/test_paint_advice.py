"""Samples to measure next: new ones, and worth what is predicted."""

import numpy as np
import pytest

from tests.extras.paint.invented import invented, measured
from uplift.extras.paint.paint_advice import advise_samples
from uplift.extras.paint.paint_fit import fit_paints


def test_samples_are_new_and_each_lowers_the_error(opaque_fit):
    advice = advise_samples(opaque_fit, 10)
    names = [sample.name for sample in advice.samples]
    assert sorted(names) == [
        "1 white : 1 red",
        "1 white : 1 yellow",
        "1 yellow : 1 red",
    ]
    errors = [advice.error, *(sample.error for sample in advice.samples)]
    assert (np.diff(errors) < 0).all()
    first = advise_samples(opaque_fit, 1)
    assert first.samples == advice.samples[:1]


def test_a_measured_sample_is_worth_what_was_predicted(three_paints, opaque_fit):
    """The fit with the sample expects the error that was predicted for it."""
    samples = opaque_fit.samples
    advice = advise_samples(opaque_fit, 1)
    name = advice.samples[0].name
    used = [f"1 {paint}" in name for paint in three_paints.names]
    shares = np.concatenate([samples.shares, [np.array(used) / 2]])
    more = fit_paints(measured(three_paints, shares))
    after = advise_samples(more, 5)
    assert after.error == pytest.approx(advice.samples[0].error, rel=0.1)
    assert name not in [sample.name for sample in after.samples]


def test_one_paint_has_an_expected_error():
    """That of the paint itself, as it has no mixtures."""
    white = invented(names=("white",))
    advice = advise_samples(fit_paints(measured(white, np.eye(1))))
    assert 0 < advice.error < 1
    assert advice.samples == ()
