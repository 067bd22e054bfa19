"""A comparison of few representations, shared by the session."""

from __future__ import annotations

import pytest

from tests.lab.comparison_scenes import colorchecker
from uplift.lab.comparison.compare import Comparison, Scene, TimingOptions, compare
from uplift.scene.representations.composite import enhanced_riemann, sun_composite
from uplift.scene.representations.models import trigonometric_moments
from uplift.scene.representations.samples import point_samples, riemann_sums

EFFORT = TimingOptions(runs=3, seconds=0.001, rows=32)


@pytest.fixture(scope="session")
def checker() -> Scene:
    return colorchecker()


@pytest.fixture(scope="session")
def found(checker) -> Comparison:
    made = [make(count) for make in (point_samples, riemann_sums, enhanced_riemann) for count in (16, 32)]
    return compare(checker, [*made, sun_composite(15), trigonometric_moments(9)], EFFORT)
