"""The still life of measured materials: what is visible, and the light on it."""

from benchmarks import still_life
from tests.parts import MITSUBA, need


def test_pixels_are_mixtures_of_lit_materials_that_are_all_visible(monkeypatch):
    need(MITSUBA)
    for name, value in {"WIDTH": 96, "HEIGHT": 50, "LIGHT_SAMPLES": 4}.items():
        monkeypatch.setattr(still_life, name, value)
    weights = still_life.still_life()
    assert weights.shape == (50, 96, still_life.MATERIALS)
    assert weights.min() >= 0
    lit = weights.sum(axis=2)
    assert lit.max() <= 1 + 1e-12
    assert 0.2 < lit.mean() < 0.9
    assert (weights.max(axis=(0, 1)) > 0.1).all()
