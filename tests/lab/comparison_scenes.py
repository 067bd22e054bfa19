"""The scene that representations are tested on: the ColorChecker under the lights of the thesis."""

from __future__ import annotations

import functools

import uplift
from tests.conftest import MACBETH
from uplift.lab.comparison.scene import Scene, scene


@functools.cache
def colorchecker() -> Scene:
    return scene({"macbeth": uplift.read_atlas(MACBETH)})
