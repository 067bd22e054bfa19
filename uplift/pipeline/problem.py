"""The problem that the options of a build describe, and the lattice of ``dim="auto"``."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from uplift.colorimetry import observer as observers
from uplift.colorimetry.camera import Camera
from uplift.colorimetry.lights import ERROR_ILLUMINANT
from uplift.common.errors import OptionError, unknown_name
from uplift.common.text import format_value
from uplift.fit.prior import Prior
from uplift.fit.problem import Problem
from uplift.fit.seeds import DIMS, Blend, choose_lattice
from uplift.pipeline.entries import Constraints, warn
from uplift.pipeline.options import CUSTOM, SOLVERS, Options, check_memory

if TYPE_CHECKING:
    from uplift.fit.optimistix_solvers import Solver


def problem_of(options: Options, observer: str | Camera, solver: str | Solver) -> tuple[Options, Problem]:
    """Return the problem of a build, and options with the names of the space and of a camera, not aliases or files."""
    sensor = observers.sensor(
        options.space, options.illuminant, observer if isinstance(observer, Camera) else options.observer
    )
    sensor = observers.on_range(sensor, options.shortest, options.longest, options.step)
    problem = Problem(
        sensor,
        options.spectrum_model(),
        tuple(observers.light(name, sensor.observer, *sensor.range) for name in options.lights),
        observers.light(ERROR_ILLUMINANT, sensor.observer, *sensor.range),
        options.threshold,
    )
    if solver != SOLVERS[0]:
        problem = replace(problem, solver=_other_solver(solver, problem.tolerance))
    if sensor.sensitivities is None:
        return replace(options, space=sensor.space), problem
    return replace(options, observer=sensor.space), problem


def _other_solver(solver: str | Solver, tolerance: float) -> Solver:
    """Return a solver of optimistix, by its name or as given."""
    from uplift.fit import optimistix_solvers

    if isinstance(solver, optimistix_solvers.SOLVER_TYPES):
        return solver
    if not isinstance(solver, str):
        raise OptionError(f"solver must be a name or a least-squares solver of optimistix, got {format_value(solver)}")
    if solver == CUSTOM:
        raise unknown_name(solver, SOLVERS, "solver")
    return optimistix_solvers.stock_solver(solver, tolerance)


def choose_dim(options: Options, problem: Problem, constraints: Constraints, prior: Prior, blend: Blend) -> Options:
    """Replace ``dim="auto"`` by the smallest lattice that keeps every entry, if it fits into memory."""
    axis, dim, lost = choose_lattice(problem, prior, blend, constraints.at_nodes, options.auto_tolerance)
    if lost:
        warn(
            f"no dim up to {DIMS[-1]} keeps every entry within ΔE00 {options.auto_tolerance:g}: "
            f"{lost} of {len(constraints.names)} are too close to others; dim {dim} keeps the most",
            "no-dim-keeps-all-entries",
        )
    options = replace(options, axis=axis, dim=dim)
    check_memory(options)
    return options
