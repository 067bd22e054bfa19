"""Gaussian quadrature for sampled weights: polynomial exactness, which defines
them, and undefined orders.
"""

import numpy as np
import pytest
from numpy.polynomial import legendre
from numpy.testing import assert_array_equal

from tests.helpers import raises
from uplift.common.errors import OptionError
from uplift.extras.papers.wavelengths.quadrature import gauss_rule, interpolatory_rule

POINTS = np.arange(380.0, 771.0)
BELL = np.exp(-(((POINTS - 560) / 40) ** 2))


def _moment_error(rule, points, masses, degree):
    """Largest error over Legendre polynomials up to ``degree``, relative to the sum of
    the absolute masses.
    """
    middle = (points[0] + points[-1]) / 2
    half = (points[-1] - points[0]) / 2
    exact = masses @ legendre.legvander((points - middle) / half, degree)
    result = rule.weights @ legendre.legvander((rule.nodes - middle) / half, degree)
    return float(np.abs(result - exact).max() / np.abs(masses).sum())


@pytest.mark.parametrize("order", [1, 3, 8, 20])
def test_rule_is_exact_to_degree_2n_minus_1_and_no_further(order):
    rule = gauss_rule(POINTS, BELL, order)
    assert len(rule) == order
    assert (rule.weights > 0).all()
    assert _moment_error(rule, POINTS, BELL, 2 * order - 1) < 1e-12
    if order <= 8:
        assert _moment_error(rule, POINTS, BELL, 2 * order) > 1e-9


@pytest.mark.parametrize(
    ("masses", "order", "reason"),
    [
        ([1, 0, -1], 1, "no polynomial"),
        ([1, 1, -1], 1, "a node lies at -1.0, outside 0 to 2"),
        ([1, -4, 1], 2, "not real"),
        ([-4, -12, 12, -2], 2, "coincide"),
    ],
)
def test_undefined_order_states_its_reason(masses, order, reason):
    with raises(OptionError, "undefined-rule") as caught:
        gauss_rule(range(len(masses)), masses, order)
    assert reason in caught.value.problem


@pytest.mark.parametrize(
    "nodes", [[560.0], [631.4, 490.9, 557.7], np.linspace(400, 700, 12)]
)
def test_interpolatory_rule_is_exact_below_its_number_of_nodes(nodes):
    rule = interpolatory_rule(nodes, POINTS, BELL)
    assert_array_equal(rule.nodes, np.sort(nodes))
    assert _moment_error(rule, POINTS, BELL, len(nodes) - 1) < 1e-12
