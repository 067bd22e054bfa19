"""The still life of measured materials: what is visible, and the light on it."""

import pytest

from benchmarks import still_life
from tests.parts import MITSUBA, need


@pytest.fixture(scope="module")
def weights():
    need(MITSUBA)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(still_life, "WIDTH", 96)
        patch.setattr(still_life, "HEIGHT", 50)
        patch.setattr(still_life, "LIGHT_SAMPLES", 4)
        return still_life.still_life()


def test_pixels_are_mixtures_of_lit_materials(weights):
    assert weights.shape == (50, 96, still_life.MATERIALS)
    assert weights.min() >= 0
    assert weights.sum(axis=2).max() <= 1 + 1e-12
    assert 0.2 < weights.sum(axis=2).mean() < 0.9


def test_every_material_is_visible(weights):
    assert (weights.max(axis=(0, 1)) > 0.1).all()
