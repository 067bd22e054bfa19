"""Design of the stability study: which of tens of thousands of possible builds are run.

A grid varies one axis against the model variants, with the other axes at values for which it has an effect. A Latin
hypercube sample of all combinations covers the rest.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import prod
from typing import Any

import numpy as np

from uplift.common.errors import OptionError
from uplift.lab.study.pointwise import IN_MOMENTS, IN_MULTIPLIERS
from uplift.lab.study.stability import NO_ATLAS, UPLIFT, RunConfig
from uplift.lab.study.synthetic_atlases import SYNTHETIC_ATLASES
from uplift.models import Moments, Sigmoid
from uplift.pipeline.options import MODELS

SPACES = ("sRGB", "P3-D65", "ITU-R BT.2020", "ACEScg", "ProPhoto RGB")
DEFAULT_DIM, DEFAULT_THRESHOLD = 17, 1e-4
SMALL_DIM = 9
"""Size of slow builds: thresholds near the rounding of stored numbers, in wide-gamut spaces."""
COMPARED_COEFFICIENTS = (3, 5, 9)
"""Coefficients of the runs of scipy's solver, which takes too long with more."""
MAX_SAMPLED_DIM = 17
"""Largest size in the sample."""
SEED = 4


@dataclass(frozen=True)
class DesignSpace:
    """Values of each axis of the design.

    Parameters
    ----------
    dims, coefficients, spaces, models, thresholds, atlases : tuple
        Values of the fields of `RunConfig`, not empty.
    samples : int
        Size of the Latin hypercube sample.
    solver_dims : tuple of int
        Sizes of the lattices on which solvers are compared.
    """

    dims: tuple[int, ...] = (4, 8, 17, 32, 64)
    coefficients: tuple[int, ...] = (3, 5, 9, 17)
    spaces: tuple[str, ...] = SPACES
    models: tuple[str, ...] = MODELS
    thresholds: tuple[float, ...] = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
    atlases: tuple[str, ...] = (NO_ATLAS, *SYNTHETIC_ATLASES)
    samples: int = 12
    solver_dims: tuple[int, ...] = (4,)

    def __post_init__(self) -> None:
        for name in ("dims", "coefficients", "spaces", "models", "thresholds", "atlases"):
            if not getattr(self, name):
                raise OptionError(f"{name} must not be empty", code="empty-axis", hint="give at least one value")

    @property
    def variants(self) -> tuple[RunConfig, ...]:
        """A configuration for every model and number of coefficients."""
        moments = [RunConfig("moments", count) for count in self.coefficients if Moments.name in self.models]
        return (*moments, *[RunConfig("sigmoid", Sigmoid.count)] * (Sigmoid.name in self.models))

    def nearest_dim(self, dim: int) -> int:
        """Nearest value of ``dims``."""
        return min(self.dims, key=lambda value: abs(value - dim))

    def fixed(self, **preferred: Any) -> dict[str, Any]:
        """Values of the axes that a grid does not vary: the preferred or default value if present, else the first."""
        return {
            "dim": self.nearest_dim(preferred.get("dim", DEFAULT_DIM)),
            "space": _preferred(self.spaces, preferred.get("space", SPACES[0])),
            "threshold": _preferred(self.thresholds, preferred.get("threshold", DEFAULT_THRESHOLD)),
            "atlas": _preferred(self.atlases, NO_ATLAS),
        }


QUICK_DESIGN = DesignSpace(
    dims=(4, 9),
    coefficients=(3, 9),
    spaces=(SPACES[0], SPACES[-1]),
    thresholds=(1e-3, 1e-4, 1e-5),
    samples=4,
    solver_dims=(4,),
)


@dataclass(frozen=True)
class Grid:
    """One axis against the model variants.

    Parameters
    ----------
    title : str
        Title of the figure.
    axis : str
        Field of `RunConfig` that varies.
    values : tuple
        Values of the axis.
    variants : tuple of RunConfig
        Models and numbers of coefficients.
    fixed : dict
        Values of the other fields.
    """

    title: str
    axis: str
    values: tuple[Any, ...]
    variants: tuple[RunConfig, ...]
    fixed: dict[str, Any]

    def rows(self) -> Iterator[tuple[str, list[RunConfig]]]:
        """Yield the label of every variant, and its configurations along the axis."""
        for variant in self.variants:
            configs = [replace(variant, **self.fixed | {self.axis: value}) for value in self.values]
            yield variant.model_label, configs


def grids(space: DesignSpace) -> tuple[Grid, ...]:
    """Make the grids of a design, without repetition."""
    default = space.fixed()
    wide_and_small = space.fixed(space=SPACES[-1], dim=SMALL_DIM)
    axes = [
        ("space", space.spaces, default),
        ("threshold", space.thresholds, default),
        ("threshold", space.thresholds, wide_and_small),
        ("atlas", space.atlases, default),
        ("dim", space.dims, default),
    ]
    by_title = {}
    for axis, values, fixed in axes:
        rest = ", ".join(_describe(name, value) for name, value in fixed.items() if name != axis)
        title = f"by {axis}: {rest}"
        by_title[title] = Grid(title, axis, values, space.variants, fixed)
    return tuple(by_title.values())


def solver_runs(space: DesignSpace) -> tuple[RunConfig, ...]:
    """Configurations that compare the solver of the thesis, in both unknowns, with that of this package."""
    if Moments.name not in space.models or SPACES[0] not in space.spaces:
        return ()
    return tuple(
        RunConfig("moments", count, dim, solver=solver)
        for dim in space.solver_dims
        for count in COMPARED_COEFFICIENTS
        if count in space.coefficients
        for solver in (IN_MOMENTS, IN_MULTIPLIERS, UPLIFT)
    )


def draw_sample(space: DesignSpace) -> tuple[RunConfig, ...]:
    """Draw distinct configurations up to `MAX_SAMPLED_DIM` from Latin hypercubes with a fixed seed."""
    from scipy.stats import qmc

    dims = [dim for dim in space.dims if dim <= MAX_SAMPLED_DIM] or [min(space.dims)]
    axes = (space.variants, dims, space.spaces, space.thresholds, space.atlases)
    sizes = [len(values) for values in axes]
    count = min(space.samples, prod(sizes))
    hypercube = qmc.LatinHypercube(len(sizes), rng=np.random.default_rng(SEED))
    drawn: dict[RunConfig, None] = {}
    while len(drawn) < count:  # several points of one hypercube may be the same combination
        for row in hypercube.integers(np.zeros(len(sizes), int), u_bounds=sizes, n=count).tolist():
            variant, dim, rgb_space, threshold, atlas = (axis[i] for axis, i in zip(axes, row, strict=True))
            drawn[replace(variant, dim=dim, space=rgb_space, threshold=threshold, atlas=atlas)] = None
    return tuple(drawn)[:count]


def design(space: DesignSpace) -> tuple[RunConfig, ...]:
    """List every configuration of the grids, the sample and the solver comparison once."""
    in_grids = [config for grid in grids(space) for _, row in grid.rows() for config in row]
    return tuple(dict.fromkeys([*in_grids, *draw_sample(space), *solver_runs(space)]))


def _preferred(values: tuple[Any, ...], preferred: Any) -> Any:
    return preferred if preferred in values else values[0]


def _describe(name: str, value: Any) -> str:
    if name == "atlas":
        return "no atlas" if value == NO_ATLAS else f"atlas {value}"
    return {"dim": f"{value}³", "threshold": f"threshold {value}"}.get(name, f"{value}")
