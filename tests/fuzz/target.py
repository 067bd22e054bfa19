"""What is attacked: how its inputs are made, and what a user does with one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[2]


@dataclass(frozen=True)
class Target:
    """``write`` makes an input from random numbers, as a file; ``use`` may raise `UpliftError`, and nothing else."""

    name: str
    write: Callable[[np.random.Generator, Path], None]
    use: Callable[[Path], None]
