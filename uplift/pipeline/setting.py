"""What every stage of a build uses: the options, as objects of the layers below."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

from uplift import fit
from uplift.colorimetry import observer as observers
from uplift.colorimetry.camera import Camera
from uplift.colorimetry.lights import ERROR_ILLUMINANT
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.errors import OptionError, unknown_name
from uplift.common.text import format_value
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap, forward_map
from uplift.pipeline.options import CUSTOM, SOLVERS, Options

if TYPE_CHECKING:
    from uplift.fit.stock_solver import Solver


@dataclass(frozen=True, eq=False)
class Setting:
    """The options of a build, and what follows from them alone.

    Parameters
    ----------
    options : Options
        The options; spaces have their own names, not aliases.
    sensor : Sensor
        RGB space, illuminant and observer, on the wavelengths of the cube.
    model, entry_model : Model
        Spectrum models of the nodes and of the atlas entries.
    lights : tuple of Light
        Lights under which entries should keep their colours.
    error_light : Light
        Light under which errors are stated.
    solver : optimistix.AbstractLeastSquaresSolver or None
        Solver of the objective of entries; None for the default.
    method : callable
        Solver of the nodes; see `uplift.fit.Problem`.
    """

    options: Options
    sensor: Sensor
    model: Model
    entry_model: Model
    lights: tuple[Light, ...]
    error_light: Light
    solver: Solver | None
    method: fit.Method

    @cached_property
    def forward(self) -> ForwardMap:
        """Map from multipliers of the nodes to RGB."""
        return self.forward_of(self.model)

    def forward_of(self, model: Model) -> ForwardMap:
        """Return the map from multipliers of a model to RGB."""
        return forward_map(model, self.sensor.wavelengths, self.sensor.matrix)

    @property
    def tolerance(self) -> float:
        """Largest residual of fitted spectra, in linear RGB."""
        return fit.solver_tolerance(self.options.threshold)

    @cached_property
    def problem(self) -> fit.Problem:
        """The problem of fitting colours, without a lattice."""
        return fit.Problem(self.model, self.forward, fit.NO_LATTICE, self.options.threshold, method=self.method)


def make_setting(options: Options, observer: str | Camera, solver: str | Solver) -> Setting:
    """Return the setting of a build.

    Parameters
    ----------
    options : Options
        The options.
    observer : str or Camera
        The observer: its name, or a camera, which options only name.
    solver : str or optimistix.AbstractLeastSquaresSolver
        The solver: its name, or the object, which options cannot record.

    Returns
    -------
    Setting

    Raises
    ------
    OptionError
        A solver of another type (code ``option-type``), or unknown names of options.
    """
    chosen, method = _solver(solver, fit.solver_tolerance(options.threshold))
    observed = observer if isinstance(observer, Camera) else options.observer
    sensor = observers.on_range(
        observers.sensor(options.space, options.illuminant, observed),
        options.shortest,
        options.longest,
        options.step,
    )
    options = _with_names(options, sensor)
    return Setting(
        options,
        sensor,
        options.spectrum_model(),
        options.entry_model(),
        tuple(observers.light(name, sensor.observer, *sensor.range) for name in options.lights),
        observers.light(ERROR_ILLUMINANT, sensor.observer, *sensor.range),
        chosen,
        method,
    )


def _with_names(options: Options, sensor: Sensor) -> Options:
    """Record the names of the space, not an alias, which $OCIO may define, and of a camera, not its file."""
    if sensor.sensitivities is None:
        return replace(options, space=sensor.space)
    return replace(options, observer=sensor.space)


def _solver(solver: str | Solver, tolerance: float) -> tuple[Solver | None, fit.Method]:
    """The solver of optimistix, None for the step of least change, and the method for lattices."""
    if solver == SOLVERS[0]:
        return None, fit.solve
    from uplift.fit import stock_solver  # imports optimistix, which the default does not need

    if isinstance(solver, stock_solver.SOLVER_TYPES):
        return solver, stock_solver.StockSolver(solver)
    if not isinstance(solver, str):
        raise OptionError(
            f"solver must be a name or a least-squares solver of optimistix, got {format_value(solver)}",
            code="option-type",
        )
    if solver == CUSTOM:
        raise unknown_name(solver, SOLVERS, "solver")
    chosen = stock_solver.STOCK[solver](tolerance)
    return chosen, stock_solver.StockSolver(chosen)
