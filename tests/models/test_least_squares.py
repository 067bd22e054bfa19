"""Least squares by rows against scipy, and with limited variables."""

import numpy as np
import scipy.optimize

from uplift.models.least_squares import ROWS, least_squares

RNG = np.random.default_rng(4)
COUNT = ROWS + 3
GOALS = RNG.uniform(0.1, 3, (COUNT, 4))
AT = np.arange(1, 5)


def residuals(y, rows):
    """Of the curve a exp(b t / 4) at four places."""
    return y[:, :1] * np.exp(y[:, 1:] * AT / 4) - GOALS[rows]


def normal_equations(y, values, rows):
    growth = np.exp(y[:, 1:] * AT / 4)
    jacobian = np.stack([growth, y[:, :1] * AT / 4 * growth], axis=2)
    return jacobian.mT @ jacobian, (jacobian.mT @ values[..., None])[..., 0]


def found_from(start, **options):
    return least_squares(residuals, normal_equations, start, max_steps=200, **options)


def test_minima_are_those_of_scipy():
    found = found_from(np.ones((COUNT, 2)))
    for row in (0, 1, ROWS, COUNT - 1):
        oracle = scipy.optimize.least_squares(
            lambda y, row=row: residuals(y[None], [row])[0], np.ones(2)
        )
        ours = residuals(found[row : row + 1], [row])
        assert (ours**2).sum() <= 2 * oracle.cost * (1 + 1e-6)


def test_variables_stay_within_the_limit():
    """No squares increase."""
    start = np.ones((COUNT, 2))
    rows = np.arange(COUNT)
    found = found_from(start, limit=1.2)
    assert np.abs(found).max() == 1.2
    before, after = (residuals(y, rows) ** 2 for y in (start, found))
    assert (after.sum(axis=1) <= before.sum(axis=1)).all()
