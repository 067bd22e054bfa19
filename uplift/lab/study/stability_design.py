"""Which builds the failure map is made of: all of them would be tens of thousands.

A grid of every axis against the techniques, the rest held where that axis has something to show, and beside the
grids a sample drawn from everything, so that no combination is safe because nobody looks.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from uplift.common.errors import OptionError
from uplift.lab.study.pointwise import IN_MOMENTS, IN_MULTIPLIERS
from uplift.lab.study.stability import NO_ATLAS, RunConfig
from uplift.lab.study.synthetic_atlases import SYNTHETIC_ATLASES
from uplift.models import Moments, Sigmoid
from uplift.pipeline.options import MODELS

SPACES = ("sRGB", "P3-D65", "ITU-R BT.2020", "ACEScg", "ProPhoto RGB")
SMALL = 9
"""Dim of what takes long: thresholds near the rounding of what is stored, in wide spaces."""
COMPARED = (3, 5, 9)
"""Coefficients that the thesis's solver is tried with: it takes no more."""
LARGEST_DRAWN = 17
"""Dim that the sample goes up to."""


@dataclass(frozen=True)
class DesignSpace:
    """The values to choose from; ``drawn`` settings are a sample of them all."""

    dims: tuple[int, ...] = (4, 8, 17, 32, 64)
    coefficients: tuple[int, ...] = (3, 5, 9, 17)
    spaces: tuple[str, ...] = SPACES
    models: tuple[str, ...] = MODELS
    thresholds: tuple[float, ...] = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
    atlases: tuple[str, ...] = (NO_ATLAS, *SYNTHETIC_ATLASES)
    drawn: int = 12
    peer_dims: tuple[int, ...] = (4,)

    def __post_init__(self) -> None:
        for name in ("dims", "coefficients", "spaces", "models", "thresholds", "atlases"):
            if not getattr(self, name):
                raise OptionError(f"no {name} to study", hint="give at least one")

    @property
    def techniques(self) -> tuple[RunConfig, ...]:
        """One setting for every model and count of coefficients."""
        found = [RunConfig("moments", count) for count in self.coefficients if Moments.name in self.models]
        return (*found, *[RunConfig("sigmoid", 3)] * (Sigmoid.name in self.models))

    def base(self, **preferred: Any) -> dict[str, Any]:
        """What a grid holds fast: the preferred values where they are among those chosen, else the nearest."""
        wanted: dict[str, Any] = {
            "dim": 17,
            "space": SPACES[0],
            "threshold": 1e-4,
            "atlas": NO_ATLAS,
        } | preferred
        return {
            "dim": min(self.dims, key=lambda dim: abs(dim - wanted["dim"])),
            "space": _in(self.spaces, wanted["space"]),
            "threshold": _in(self.thresholds, wanted["threshold"]),
            "atlas": _in(self.atlases, wanted["atlas"]),
        }


QUICK_DESIGN = DesignSpace(
    dims=(4, 9),
    coefficients=(3, 9),
    spaces=(SPACES[0], SPACES[-1]),
    thresholds=(1e-3, 1e-4, 1e-5),
    drawn=4,
    peer_dims=(4,),
)


@dataclass(frozen=True)
class Grid:
    """An axis of `RunConfig` against the techniques."""

    title: str
    axis: str
    values: tuple[Any, ...]
    techniques: tuple[RunConfig, ...]
    fixed: dict[str, Any]

    def rows(self) -> Iterator[tuple[str, list[RunConfig]]]:
        """Every technique's name, and its settings along the axis."""
        for technique in self.techniques:
            yield (
                technique.technique,
                [replace(technique, **self.fixed | {self.axis: value}) for value in self.values],
            )


def grids(axes: DesignSpace) -> tuple[Grid, ...]:
    """The grids; a later one of the same settings costs nothing."""
    techniques, wide = axes.techniques, _in(axes.spaces, SPACES[-1])
    small = {"dim": min(axes.dims, key=lambda dim: abs(dim - SMALL))}
    chosen = [
        ("space", axes.spaces, axes.base()),
        ("threshold", axes.thresholds, axes.base()),
        ("threshold", axes.thresholds, axes.base(space=wide) | small),
        ("atlas", axes.atlases, axes.base()),
        ("dim", axes.dims, axes.base()),
    ]
    found = {}
    for axis, values, fixed in chosen:
        told = {name: value for name, value in fixed.items() if name != axis}
        title = f"by {axis}: {', '.join(_told(name, value) for name, value in told.items())}"
        found[title] = Grid(title, axis, values, techniques, fixed)
    return tuple(found.values())


def solver_runs(axes: DesignSpace) -> tuple[RunConfig, ...]:
    """The thesis's solver in its own unknowns and in ours, and our solver, on small sRGB lattices."""
    if Moments.name not in axes.models or SPACES[0] not in axes.spaces:
        return ()
    return tuple(
        RunConfig("moments", count, dim, solver=solver)
        for dim in axes.peer_dims
        for count in COMPARED
        if count in axes.coefficients
        for solver in (IN_MOMENTS, IN_MULTIPLIERS, RunConfig.solver)
    )


def draw_sample(axes: DesignSpace) -> tuple[RunConfig, ...]:
    """Settings drawn from everything up to `LARGEST_DRAWN`; always the same."""
    dims = [dim for dim in axes.dims if dim <= LARGEST_DRAWN] or [min(axes.dims)]
    every = [
        replace(technique, dim=dim, space=space, threshold=threshold, atlas=atlas)
        for technique, dim, space, threshold, atlas in product(
            axes.techniques, dims, axes.spaces, axes.thresholds, axes.atlases
        )
    ]
    count = min(axes.drawn, len(every))
    drawn = np.random.default_rng(4).choice(len(every), count, replace=False)
    return tuple(every[number] for number in drawn)


def design(axes: DesignSpace) -> tuple[RunConfig, ...]:
    """Every setting of the grids, the sample and the peers, once."""
    in_grids = [setting for grid in grids(axes) for _, row in grid.rows() for setting in row]
    return tuple(dict.fromkeys([*in_grids, *draw_sample(axes), *solver_runs(axes)]))


def _in(values: tuple[Any, ...], wanted: Any) -> Any:
    return wanted if wanted in values else values[0]


def _told(name: str, value: Any) -> str:
    if name == "atlas":
        return "no atlas" if value == NO_ATLAS else f"atlas {value}"
    return {"dim": f"{value}³", "threshold": f"threshold {value}"}.get(name, f"{value}")
