"""Build options and their validation."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Any, Literal

import numpy as np

from uplift.colorimetry.camera import CAMERA
from uplift.colorimetry.lights import DEFAULT_ILLUMINANT, SCENE_LIGHTS
from uplift.colorimetry.observer import DEFAULT_OBSERVER, END, START, STEP
from uplift.common.errors import OptionError, unknown_name
from uplift.common.text import format_value
from uplift.cube.metadata import MAX_LIGHTS, MAX_THRESHOLD, MIN_THRESHOLD
from uplift.models import Model, Moments, Phase, Sigmoid
from uplift.models.moments import MAX_COUNT

AUTO: Literal["auto"] = "auto"
AXES = ("srgb", "linear")
ModelName = Literal["moments", "sigmoid"]
MODELS: tuple[ModelName, ...] = ("moments", "sigmoid")
PriorName = Literal["learnt", "smooth"]
PRIORS: tuple[PriorName, ...] = ("learnt", "smooth")
STARTS = ("prior", "neighbours")
SolverName = Literal["least-change", "dogleg", "levenberg-marquardt", "gauss-newton"]
SOLVERS: tuple[SolverName, ...] = ("least-change", "dogleg", "levenberg-marquardt", "gauss-newton")
CUSTOM = "custom"
"""Recorded in place of a solver that was given as an object, and cannot be repeated."""
MAX_AUTO_TOLERANCE = 100.0
"""ΔE00 between black and white."""
MAX_RANGE = 300.0, 1000.0
"""Limits of the range in nm: illuminants and observers have no shorter wavelengths, atlases hardly longer ones."""
STEPS = (1.0, 5.0, 10.0)
"""Steps of the sensor's wavelengths in nm."""
PROCESS_BYTES = 500_000_000
"""Memory of a build without its lattice."""

RENAMED = {"within": "auto_tolerance"}
"""Options by the names that earlier versions recorded in cubes."""


@dataclass(frozen=True)
class Options:
    """Options of `uplift.build`, recorded in the cube so that the build can be repeated.

    The parameters are those of `uplift.build`.

    Raises
    ------
    OptionError
        A value of another type (``option-type``) or outside its range.
    UnknownNameError
        An unknown model, axis, start or solver.
    """

    dim: int | Literal["auto"] = 32
    model: str = "moments"
    coefficients: int = 9
    entry_coefficients: int = MAX_COUNT
    warp: str = "none"
    axis: str = "srgb"
    space: str = "sRGB"
    illuminant: str = DEFAULT_ILLUMINANT
    observer: str = DEFAULT_OBSERVER
    shortest: float = START
    longest: float = END
    step: float = STEP
    lights: tuple[str, ...] = SCENE_LIGHTS
    prior: str = "learnt"
    leave_out: tuple[str, ...] = ()
    threshold: float = 1e-4
    auto_tolerance: float = 0.5
    seed_corners: bool = False
    start: str = "prior"
    solver: str = "least-change"
    debug: bool = False

    def __post_init__(self) -> None:
        for name, convert in CONVERSIONS.items():
            object.__setattr__(self, name, convert(name, getattr(self, name)))
        self._check_range()
        self.spectrum_model()
        self._check_entry_coefficients()
        if self.axis not in AXES:
            raise unknown_name(self.axis, AXES, "axis spacing")
        if self.prior not in PRIORS:
            raise unknown_name(self.prior, PRIORS, "prior")
        if self.start not in STARTS:
            raise unknown_name(self.start, STARTS, "start")
        if self.solver not in (*SOLVERS, CUSTOM):
            raise unknown_name(self.solver, SOLVERS, "solver")
        if not self.lights:
            raise OptionError("lights must name at least one illuminant, got none", code="no-lights")
        if len(self.lights) > MAX_LIGHTS:
            raise OptionError(
                f"lights must name at most {MAX_LIGHTS} illuminants, got {len(self.lights)}",
                code="too-many-lights",
            )
        if not MIN_THRESHOLD <= self.threshold <= MAX_THRESHOLD:
            raise OptionError(
                f"threshold must be in [{MIN_THRESHOLD:g}, {MAX_THRESHOLD}], got {self.threshold:g}",
                code="threshold-out-of-range",
                hint="use 1e-6 to 0.1",
            )
        if not 0 <= self.auto_tolerance <= MAX_AUTO_TOLERANCE:
            raise OptionError(
                f"auto_tolerance must be a ΔE00 in [0, {MAX_AUTO_TOLERANCE:g}], got {self.auto_tolerance:g}",
                code="auto-tolerance-out-of-range",
            )

    def spectrum_model(self) -> Model:
        """Create the spectrum model that the options describe.

        Returns
        -------
        Model
            `Moments` or `Sigmoid` from `shortest` to `longest` nm.
        """
        return self._model(self.coefficients)

    def entry_model(self) -> Model:
        """Create the spectrum model of the atlas entries.

        Returns
        -------
        Model
            That of the lattice, with `entry_coefficients` coefficients for moments.
        """
        return self._model(self.entry_coefficients)

    def _model(self, coefficients: int) -> Model:
        if self.model == Moments.name:
            return Moments(coefficients, Phase(self.shortest, self.longest, self.warp))
        if self.model == Sigmoid.name:
            return Sigmoid(self.shortest, self.longest)
        raise unknown_name(self.model, MODELS, "model")

    def _check_range(self) -> None:
        low, high = MAX_RANGE
        if not low <= self.shortest <= START < END <= self.longest <= high:
            raise OptionError(
                f"the range must hold {START:g} to {END:g} nm and lie within {low:g} to {high:g} nm, "
                f"got {self.shortest:g} to {self.longest:g}",
                code="range-out-of-limits",
            )
        if self.space == CAMERA and self.step > STEP:  # a rebuild has the sensitivities of the cube only
            raise OptionError(
                f"step of a camera's cube must be 1 or 5 nm, got {self.step:g}",
                code="unsupported-step",
                hint="use 5",
            )
        if self.step not in STEPS:
            raise OptionError(f"step must be 1, 5 or 10 nm, got {self.step:g}", code="unsupported-step", hint="use 5")
        if (self.longest - self.shortest) % self.step:
            raise OptionError(
                f"the range must be a multiple of the step of {self.step:g} nm, "
                f"got {self.shortest:g} to {self.longest:g}",
                code="range-not-in-steps",
                hint="use a step of 1",
            )

    def _check_entry_coefficients(self) -> None:
        if self.model == Moments.name and not self.coefficients <= self.entry_coefficients <= MAX_COUNT:
            value = format_value(self.entry_coefficients)
            raise OptionError(
                f"entry_coefficients must be in [{self.coefficients}, {MAX_COUNT}], got {value}",
                code="entry-coefficients-out-of-range",
                hint="entries have as many coefficients as the nodes, or more",
            )


def recorded_options(options: dict[str, Any]) -> dict[str, Any]:
    """Return options read from a cube under their present names."""
    current = {RENAMED.get(name, name): value for name, value in options.items()}
    if "coefficients" in current:  # up to file version 3 entries had as many
        current.setdefault("entry_coefficients", current["coefficients"])
    current = {"prior": "smooth", "leave_out": (), **current}  # the defaults up to file version 3
    return {name: tuple(value) if isinstance(value, list) else value for name, value in current.items()}


def _dim(name: str, value: object) -> int | Literal["auto"]:
    if isinstance(value, str) and value == AUTO:
        return AUTO
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise OptionError(f"dim must be a whole number or 'auto', got {format_value(value)}", code="dim-not-a-number")
    if value < 2:
        raise OptionError(
            f"dim must be at least 2, got {format_value(int(value))}",
            code="dim-too-small",
            hint="use dim=2 or more",
        )
    return int(value)


def _whole(name: str, value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise _wrong_type(name, "a whole number", value)
    return int(value)


def _number(name: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, Real):
        raise _wrong_type(name, "a number", value)
    try:
        return float(value)
    except OverflowError:
        return np.inf


def _text(name: str, value: object) -> str:
    if not isinstance(value, str):
        raise _wrong_type(name, "text", value)
    return str(value)


def _texts(name: str, value: object) -> tuple[str, ...]:
    if not isinstance(value, tuple | list):
        raise _wrong_type(name, "a sequence of names", value)
    return tuple(_text(name, each) for each in value)


def _flag(name: str, value: object) -> bool:
    if not isinstance(value, bool | np.bool_):
        raise _wrong_type(name, "True or False", value)
    return bool(value)


def _wrong_type(name: str, kind: str, value: object) -> OptionError:
    return OptionError(f"{name} must be {kind}, got {format_value(value)}", code="option-type")


CONVERSIONS: dict[str, Callable[[str, object], Any]] = {
    "dim": _dim,
    "model": _text,
    "coefficients": _whole,
    "entry_coefficients": _whole,
    "warp": _text,
    "axis": _text,
    "space": _text,
    "illuminant": _text,
    "observer": _text,
    "shortest": _number,
    "longest": _number,
    "step": _number,
    "lights": _texts,
    "prior": _text,
    "leave_out": _texts,
    "threshold": _number,
    "auto_tolerance": _number,
    "start": _text,
    "solver": _text,
    "seed_corners": _flag,
    "debug": _flag,
}
"""Function by option that returns a plain value for JSON. Raises `OptionError` for other types."""


def check_memory(options: Options) -> None:
    """Raise `OptionError` (``dim-too-large``) if the lattice does not fit into the memory of this machine."""
    if not isinstance(options.dim, int):
        return
    dim, coefficients = options.dim, options.spectrum_model().count
    need, have = PROCESS_BYTES + dim**3 * _point_bytes(coefficients), _memory()
    if need > have:
        largest = int(max((have - PROCESS_BYTES) / _point_bytes(coefficients), 8) ** (1 / 3))
        raise OptionError(
            f"dim {format_value(dim)} needs about {_gigabytes(need)} of memory, this machine has {_gigabytes(have)}",
            code="dim-too-large",
            hint=f"use dim={largest} or less",
        )


def _point_bytes(coefficients: int) -> int:
    """Peak memory of a lattice point: multipliers, and coefficients in single precision, and the other arrays."""
    return 16 * coefficients + 60


def _gigabytes(count: int) -> str:
    return f"{min(count, 10**300) / 1e9:.3g} GB"  # a float overflows for absurd values of dim


def _memory() -> int:
    """Bytes of memory in this machine; practically infinite where the system does not report it."""
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return 1 << 62
