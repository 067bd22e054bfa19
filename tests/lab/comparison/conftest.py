"""A comparison of few representations, measured once a run."""

from __future__ import annotations

import pytest

from tests.lab.comparison_scenes import colorchecker
from uplift.lab.comparison.measure import Comparison, Effort, compare
from uplift.lab.comparison.scene import Scene
from uplift.scene.representations.composite import enhanced, sun
from uplift.scene.representations.moments import moments
from uplift.scene.representations.point import point
from uplift.scene.representations.riemann import riemann

EFFORT = Effort(runs=3, lap=0.001, rows=32)


@pytest.fixture(scope="session")
def checker() -> Scene:
    return colorchecker()


@pytest.fixture(scope="session")
def found(checker) -> Comparison:
    made = [make(count) for make in (point, riemann, enhanced) for count in (16, 32)]
    return compare(checker, [*made, sun(15), moments(9)], EFFORT)
