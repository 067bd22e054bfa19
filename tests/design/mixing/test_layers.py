"""Layers agree with the explicit sum over interreflections."""

from __future__ import annotations

import numpy as np

from uplift.design.mixing.layers import Layer

UPPER = Layer(np.array([0.2, 0.5, 0.0]), np.array([0.7, 0.1, 1.0]))
LOWER = Layer(np.array([0.3, 0.9, 0.4]), np.array([0.6, 0.1, 0.0]))


def sum_of_reflections(upper, ground):
    return upper.reflectance + sum(
        upper.transmittance**2 * ground * (upper.reflectance * ground) ** bounce for bounce in range(2000)
    )


def test_reflectance_on_a_ground_is_the_sum_of_all_reflections():
    ground = np.array([0.9, 1.0, 0.5])
    np.testing.assert_allclose(UPPER.over(ground), sum_of_reflections(UPPER, ground))


def test_black_ground_and_clear_layer():
    np.testing.assert_array_equal(UPPER.over(0), UPPER.reflectance)
    clear = Layer(np.zeros(3), np.ones(3))
    np.testing.assert_array_equal(clear.over([0.1, 0.2, 1]), [0.1, 0.2, 1])


def test_a_stack_reflects_as_the_upper_layer_on_the_lower():
    both = UPPER.stack_on(LOWER)
    np.testing.assert_allclose(both.reflectance, sum_of_reflections(UPPER, LOWER.reflectance))
    assert (both.reflectance + both.transmittance <= 1).all()


def test_perfect_mirrors_face_to_face_give_no_nan():
    mirror = Layer(np.ones(1), np.zeros(1))
    assert mirror.over(1.0) == 1
    assert np.isfinite(mirror.stack_on(mirror).reflectance).all()
