"""Fuzz target: how to generate an input and how to use it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[2]


@dataclass(frozen=True)
class Target:
    """A reader under test: ``generate`` writes an input, ``use`` reads it and may raise `UpliftError` alone."""

    name: str
    generate: Callable[[np.random.Generator, Path], None]
    use: Callable[[Path], object]
