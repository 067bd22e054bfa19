"""The scene that representations are tested on: the ColorChecker under the lights of the thesis."""

from __future__ import annotations

import functools

import uplift
from uplift.comparison.scene import Scene, scene

from .conftest import MACBETH


@functools.cache
def colorchecker() -> Scene:
    return scene({"macbeth": uplift.read_atlas(MACBETH)})
