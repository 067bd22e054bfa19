"""Fuzz target: how to generate an input and how to use it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[2]


@dataclass(frozen=True)
class Target:
    """A reader under test.

    Parameters
    ----------
    name : str
        Name for reports.
    generate : callable
        Write an input, made from a random generator, to a path.
    use : callable
        Read the input and use the result. It may raise `UpliftError` and no other exception.
    """

    name: str
    generate: Callable[[np.random.Generator, Path], None]
    use: Callable[[Path], None]
