"""Test scene of the representations: the ColorChecker under the lights of Kment 2011."""

from __future__ import annotations

import functools

import uplift
from tests.conftest import MACBETH
from uplift.lab.comparison.compare import Scene, make_scene


@functools.cache
def colorchecker() -> Scene:
    return make_scene({"macbeth": uplift.read_atlas(MACBETH)})
