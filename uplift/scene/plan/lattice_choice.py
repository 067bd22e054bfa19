"""Choice of the cube: coefficients per lattice point, dim and axis."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

from uplift.colorimetry import observer
from uplift.common.progress import Progress
from uplift.lattice import Lattice
from uplift.pipeline.options import AXES
from uplift.scene.plan.arguments import cube_args
from uplift.scene.plan.colours import occupied_cells
from uplift.scene.plan.context import PlanContext
from uplift.scene.plan.decision import Decision, Trial, decide
from uplift.scene.plan.evaluation import EvaluationSet
from uplift.viz.format import format_size

BYTES_PER_COEFFICIENT = 4
MAX_AXIS_RATIO = 2.0
"""An axis whose error exceeds the other's by this factor is not tried at larger dims."""


def choose_coefficients(context: PlanContext, tests: EvaluationSet, limit: float) -> Decision:
    """Choose the number of coefficients at the reference dim, where the lattice adds no error."""
    counts, dim = context.grid.coefficients, context.grid.reference

    def trials() -> Iterator[Trial]:
        for done, count in enumerate(counts):
            context.progress(Progress(f"{count} coefficients", done, len(counts)))
            options = {"coefficients": count}
            cube = context.cube(tests.rgb, dim=dim, **options)
            cost = f"{format_size(BYTES_PER_COEFFICIENT * count)} per point"
            error = tests.error(cube.reflectance(tests.rgb))
            yield Trial(str(count), count, cost, cube_args(options), options, error)

    return decide("coefficients", "Coefficients per spectrum", "coefficients", limit, trials())


def choose_lattice(context: PlanContext, tests: EvaluationSet, limit: float, count: int) -> Decision:
    """Choose dim and axis by the number of lattice points that the textures need."""
    dims = (*context.grid.dims, context.grid.reference)
    sizes = sorted((points_needed(context, axis, dim), dim, axis) for dim, axis in product(dims, AXES))
    latest: dict[str, float] = {}

    def trials() -> Iterator[Trial]:
        for done, (points, dim, axis) in enumerate(sizes):
            if latest.get(axis, 0) > MAX_AXIS_RATIO * min(latest.values(), default=1):
                continue
            context.progress(Progress(f"dim {dim}, {axis} axis", done, len(sizes)))
            options = {"dim": dim, "axis": axis}
            cube = context.cube(tests.rgb, coefficients=count, **options)
            cost = f"{points:,} points, {format_size(BYTES_PER_COEFFICIENT * count * points)}"
            error = tests.error(cube.reflectance(tests.rgb))
            latest[axis] = error.quantile
            yield Trial(f"{dim}³, {axis}", points, cost, cube_args(options), options, error)

    return decide("lattice", "Lattice", "lattice points that the textures need", limit, trials())


def points_needed(context: PlanContext, axis: str, dim: int) -> int:
    """Estimate the lattice points that the textures need: those around one colour of every bin."""
    lattice = Lattice(observer.axis_nodes(axis, dim))
    return int(lattice.corner_points(occupied_cells(lattice, context.colours.colour_bins)).sum())
