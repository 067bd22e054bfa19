"""The still life of measured materials: light, shadow, and what is visible."""

import numpy as np
import pytest

from benchmarks import still_life


@pytest.fixture(scope="module")
def weights():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(still_life, "WIDTH", 96)
        patch.setattr(still_life, "HEIGHT", 50)
        patch.setattr(still_life, "LAMP_RAYS", 4)
        return still_life.still_life()


def test_pixels_are_mixtures_of_lit_materials(weights):
    assert weights.shape == (50, 96, still_life.MATERIALS)
    assert weights.min() >= 0
    total = weights.sum(axis=2)
    assert total.max() <= 1 + 1e-12
    assert total.min() > 0  # all is lit by what is around


def test_every_material_is_visible(weights):
    assert (weights.max(axis=(0, 1)) > 0.1).all()


def test_rays_hit_a_ball_where_they_first_meet_it():
    directions = np.array([[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]])
    distance = still_life.to_ball(np.array([0.0, -3.0, 0.5]), directions, 1.0)
    assert distance[0] == pytest.approx(3 - np.sqrt(0.75))
    assert np.isinf(distance[1:]).all()
