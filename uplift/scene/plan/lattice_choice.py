"""The cube: how many coefficients a point, and the smallest lattice."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

from uplift.colorimetry import observer
from uplift.common.progress import Progress
from uplift.lattice import Lattice
from uplift.pipeline.options import AXES
from uplift.scene.plan.colours import occupied_cells
from uplift.scene.plan.context import PlanContext
from uplift.scene.plan.decision import Decision, Trial, decide
from uplift.scene.plan.evaluation import EvaluationSet
from uplift.viz.format import format_size

SINGLE = 4
"""Bytes of a coefficient."""
BEHIND = 2.0
"""An axis whose error is so many times the other's does not come first later on."""


def choose_coefficients(context: PlanContext, question: EvaluationSet, limit: float) -> Decision:
    """On the finest lattice, so that it has no part in the error."""
    counts, dim = context.effort.coefficients, context.effort.reference

    def trials() -> Iterator[Trial]:
        for done, count in enumerate(counts):
            context.progress(Progress(f"{count} coefficients", done, len(counts)))
            options = {"coefficients": count}
            made = context.cube(question.rgb, dim=dim, **options)
            told = f"{format_size(SINGLE * count)} a point"
            error = question.error(made.reflectance(question.rgb))
            yield Trial(str(count), count, told, f"--moments {count - 1}", options, error)

    return decide("coefficients", "Coefficients a spectrum", "coefficients", limit, trials())


def choose_lattice(context: PlanContext, question: EvaluationSet, limit: float, count: int) -> Decision:
    """Of all dims and both axes, by the points that the textures need; an axis far behind the other is given up."""
    dims = (*context.effort.dims, context.effort.reference)
    sizes = sorted((points_needed(context, axis, dim), dim, axis) for dim, axis in product(dims, AXES))
    latest: dict[str, float] = {}

    def trials() -> Iterator[Trial]:
        for done, (points, dim, axis) in enumerate(sizes):
            if latest.get(axis, 0) > BEHIND * min(latest.values(), default=1):
                continue
            context.progress(Progress(f"dim {dim}, {axis} axis", done, len(sizes)))
            options = {"dim": dim, "axis": axis}
            made = context.cube(question.rgb, coefficients=count, **options)
            told = f"{points:,} points, {format_size(SINGLE * count * points)}"
            error = question.error(made.reflectance(question.rgb))
            latest[axis] = error.quantile
            yield Trial(f"{dim}³, {axis}", points, told, f"--dim {dim} --axis {axis}", options, error)

    return decide("lattice", "Lattice", "points that the textures need", limit, trials())


def points_needed(context: PlanContext, axis: str, dim: int) -> int:
    """About how many points the textures' colours need: those around one of each kind."""
    grid = Lattice(observer.axis_nodes(axis, dim))
    return int(grid.corner_points(occupied_cells(grid, context.colours.colour_bins)).sum())
