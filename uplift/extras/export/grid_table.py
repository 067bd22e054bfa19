"""Tables over a regular grid: how many nodes they have and where, and errors of their
colours, the mean of random ones and the largest that a search finds.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.text import round_up
from uplift.extras.colour.srgb import decode, encode

SAMPLES = 1 << 13
"""Random codes of the mean, from which the search begins."""
SEED = 7
STARTS = 1 << 7
"""Worst codes that the search follows."""
TRIALS = 8
"""Trials near each of these codes in a round."""
STEPS = np.geomspace(1 / 16, 1 / 1024, 12)
"""Largest changes of codes by round."""

MIN_RES = 2


def check_res(res: int, usual: int, most: int) -> None:
    """Raise `OptionError` unless a table can have so many nodes along each axis."""
    if not MIN_RES <= res <= most:
        raise OptionError(
            f"res must be from {MIN_RES} to {most}, got {res}", hint=f"{usual} is usual"
        )


def grid_nodes(axis: Array, rank: int) -> Array:
    """Return the points (n ** rank, rank) of a grid with the same n places along each
    axis, the last axis fastest.
    """
    grid = np.meshgrid(*[axis] * rank, indexing="ij")
    return np.stack(grid, axis=-1).reshape(-1, rank)


ErrorFunction = Callable[[Array], Array]
"""From codes (n, 3) in [0, 1] to errors (n,)."""


@dataclass(frozen=True, eq=False)
class TableError:
    """Errors of colours from a table, ΔE00 from those of the cube."""

    mean: float
    """Mean of random colours, even in codes."""
    largest: float
    """Largest that a search finds."""
    worst: Array
    """Linear RGB (3,) of the colour with the largest error."""

    def __str__(self) -> str:
        worst = " ".join(f"{value:.2g}" for value in self.worst)
        return (
            f"ΔE00 from the cube's: mean {self.mean:.2g}, largest "
            f"{round_up(self.largest):g} (RGB {worst})"
        )


def find_errors(error: ErrorFunction, atlas: Array) -> TableError:
    """Find the mean error, and the largest near the worst of random codes, pairs of
    equal ones and an atlas (E, 3).

    The atlas is in linear RGB. Interpolation within tetrahedra has its largest errors
    where two components are equal.
    """
    random = np.random.default_rng(SEED)
    even = random.random((SAMPLES, 3))
    even_errors = error(even)
    rows = np.arange(SAMPLES)
    equal = even.copy()
    equal[rows, rows % 3] = even[rows, rows % 3 - 1]
    special = np.concatenate([equal, encode(atlas)])
    codes = np.concatenate([even, special])
    errors = np.concatenate([even_errors, error(special)])
    starts = np.argsort(-errors)[:STARTS]
    codes = codes[starts]
    errors = errors[starts]
    for step in STEPS:
        codes, errors = _climb(
            error, codes, errors, random.uniform(-step, step, (TRIALS, STARTS, 3))
        )
    worst = errors.argmax()
    return TableError(
        float(even_errors.mean()), float(errors[worst]), decode(codes[worst])
    )


def _climb(
    error: ErrorFunction, codes: Array, errors: Array, changes: Array
) -> tuple[Array, Array]:
    """Return codes (n, 3) moved by one of changes (t, n, 3), or not, to the largest
    error, and the errors (n,).
    """
    trials = np.clip(codes + changes, 0, 1)
    trial_errors = error(trials.reshape(-1, 3)).reshape(trials.shape[:2])
    all_codes = np.concatenate([codes[None], trials])
    all_errors = np.concatenate([errors[None], trial_errors])
    best = all_errors.argmax(axis=0)
    columns = np.arange(len(codes))
    return all_codes[best, columns], all_errors[best, columns]
