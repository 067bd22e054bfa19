"""Build options and their validation."""

from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass, fields
from numbers import Integral, Real
from typing import Any, Literal, get_args

import numpy as np

from uplift.colorimetry.camera import CAMERA
from uplift.colorimetry.illuminants import (
    DEFAULT_ILLUMINANT,
    SCENE_LIGHTS,
    Illuminant,
    Lamp,
)
from uplift.colorimetry.observer import DEFAULT_OBSERVER, END, START, STEP
from uplift.common import machine
from uplift.common.errors import OptionError, unknown_name
from uplift.common.text import format_value
from uplift.cube.container import RANGE
from uplift.cube.schema import MAX_LIGHTS, MAX_THRESHOLD, MIN_THRESHOLD
from uplift.lattice.lattice import AXES
from uplift.models.model import Model
from uplift.models.moments import MAX_COUNT, Moments
from uplift.models.sigmoid import Sigmoid

AUTO: Literal["auto"] = "auto"
ModelName = Literal["moments", "sigmoid"]
PriorName = Literal["learnt", "smooth"]
NeutralName = Literal["expected", "flat"]
GrowthName = Literal["outward", "coarse-to-fine", "neighbours"]
OUTWARD = "outward"
SolverName = Literal["least-change", "dogleg", "levenberg-marquardt", "gauss-newton"]
MODELS = get_args(ModelName)
SOLVERS = get_args(SolverName)
CUSTOM = "custom"
"""Recorded in place of a solver that was given as an object, and cannot be repeated."""
CHOICES: dict[str, tuple[str, ...]] = {
    "model": MODELS,
    "axis": AXES,
    "prior": get_args(PriorName),
    "neutral": get_args(NeutralName),
    "growth": get_args(GrowthName),
    "solver": (*SOLVERS, CUSTOM),
}
"""Names of options that have a choice."""
MAX_AUTO_TOLERANCE = 100.0
"""ΔE00 between black and white."""
STEPS = (1.0, 5.0, 10.0)
"""Steps of the sensor's wavelengths in nm."""
Dim = int | Literal["auto"]
TYPES: dict[Any, tuple[Any, type, str]] = {
    Dim: (Integral, int, "a whole number or 'auto'"),
    int: (Integral, int, "a whole number"),
    float: (Real, float, "a number"),
    str: (str, str, "text"),
    bool: (bool | np.bool_, bool, "True or False"),
}
"""By the annotation of an option: types that are accepted, that which is recorded as
JSON, and their name.
"""
RENAMED = {"within": "auto_tolerance", "start": "growth"}
"""Options by the names that earlier versions recorded in cubes."""


@dataclass(frozen=True)
class Options:
    """Options of `uplift.build`, recorded in the cube so that the build can be
    repeated.

    Raises `OptionError` for a value of another type or outside its range, and
    `UnknownNameError`.
    """

    dim: Dim = 32
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
    lights: tuple[Illuminant, ...] = SCENE_LIGHTS
    prior: str = "learnt"
    neutral: str = "expected"
    leave_out: tuple[str, ...] = ()
    threshold: float = 1e-4
    auto_tolerance: float = 0.5
    seed_corners: bool = False
    trust_atlas: bool = False
    exact_entries: bool = False
    growth: str = "outward"
    solver: str = "least-change"
    debug: bool = False

    def __post_init__(self) -> None:
        for field in fields(self):
            object.__setattr__(
                self,
                field.name,
                _plain(field.name, field.type, getattr(self, field.name)),
            )
        for problem, hint in (*self._range_faults(), *self._faults()):
            raise OptionError(problem, hint=hint)
        for option, names in CHOICES.items():
            if getattr(self, option) not in names:
                raise unknown_name(
                    getattr(self, option),
                    [name for name in names if name != CUSTOM],
                    option,
                )
        self.spectrum_model()  # which checks the coefficients

    def _range_faults(self) -> Iterator[tuple[str, str]]:
        """Yield problems of the wavelengths, with hints. The first one counts."""
        low, high = RANGE
        if not low <= self.shortest <= START < END <= self.longest <= high:
            limits = (
                f"the range must hold {START:g} to {END:g} nm and lie within {low:g} "
                f"to {high:g} nm"
            )
            yield f"{limits}, got {self.shortest:g} to {self.longest:g}", ""
        # A rebuild has the sensitivities of a camera at the wavelengths of the cube
        # only.
        steps = [step for step in STEPS if step <= STEP or self.space != CAMERA]
        if self.step not in steps:
            allowed = ", ".join(f"{step:g}" for step in steps)
            yield (
                f"step of {self.space} must be one of {allowed} nm, got {self.step:g}",
                "use 5",
            )
        if self.step in steps and (self.longest - self.shortest) % self.step != 0:
            multiple = f"the range must be a multiple of the step of {self.step:g} nm"
            yield (
                f"{multiple}, got {self.shortest:g} to {self.longest:g}",
                "use a step of 1",
            )

    def _faults(self) -> Iterator[tuple[str, str]]:
        """Yield problems of the other values, with hints."""
        if self.neutral == "flat" and self.growth == "neighbours":
            problem = (
                "neutral 'flat' does not apply to growth 'neighbours', whose nodes "
                "start from their neighbours"
            )
            yield problem, "use another growth"
        if self.dim != AUTO and self.dim < 2:
            yield f"dim must be at least 2, got {format_value(self.dim)}", "use dim=2"
        entries = self.entry_coefficients if self.model == Moments.name else MAX_COUNT
        fewest = min(self.coefficients, MAX_COUNT)
        for name, value, least, most in (
            ("number of lights", len(self.lights), 1, MAX_LIGHTS),
            ("entry_coefficients", entries, fewest, MAX_COUNT),
            ("threshold", self.threshold, MIN_THRESHOLD, MAX_THRESHOLD),
            ("auto_tolerance", self.auto_tolerance, 0, MAX_AUTO_TOLERANCE),
        ):
            if not least <= value <= most:
                limits = f"[{least:g}, {most:g}]"
                yield f"{name} must be in {limits}, got {format_value(value)}", ""

    def record(self) -> dict[str, Any]:
        """Return the options as JSON can record them; `recorded_options` reads them.
        Lamps are recorded with power.
        """
        values = asdict(self)
        return {
            name: list(value) if isinstance(value, tuple) else value
            for name, value in values.items()
        }

    def spectrum_model(self, coefficients: int | None = None) -> Model:
        """Create the spectrum model, from `shortest` to `longest` nm, of the nodes or
        of other moments.
        """
        if self.model == Sigmoid.name:
            return Sigmoid(self.shortest, self.longest)
        count = self.coefficients if coefficients is None else coefficients
        return Moments(count, self.shortest, self.longest, self.warp)

    @property
    def learns_families(self) -> bool:
        """Whether the prior learns from families of measured materials."""
        return self.prior == "learnt" and not self.spectrum_model().is_determined


def recorded_options(options: dict[str, Any]) -> dict[str, Any]:
    """Return options read from a cube under their present names."""
    current = {RENAMED.get(name, name): value for name, value in options.items()}
    if current.get("growth") == "prior":  # the default up to file version 4
        current["growth"] = "coarse-to-fine"
    if "coefficients" in current:  # up to file version 3 entries had as many
        current.setdefault("entry_coefficients", current["coefficients"])
    current = {
        "prior": "smooth",
        "leave_out": (),
        **current,
    }  # the defaults up to file version 3
    current = {
        name: tuple(value) if isinstance(value, list) else value
        for name, value in current.items()
    }
    if isinstance(current.get("lights"), tuple):
        current["lights"] = tuple(map(_recorded_light, current["lights"]))
    return current


def _recorded_light(value: Any) -> Any:
    """Return the lamp that a record describes, or any other value as it is."""
    if not isinstance(value, dict):
        return value
    try:
        return Lamp(
            str(value["name"]), tuple(value["wavelengths"]), tuple(value["power"])
        )
    except (KeyError, TypeError, ValueError) as error:
        raise OptionError(
            "a recorded lamp must have a name, wavelengths and power"
        ) from error


def _plain(name: str, kind: Any, value: Any) -> Any:
    """Return the value of an option, by its annotation, as JSON can record it."""
    if kind in (tuple[str, ...], tuple[Illuminant, ...]):
        return _plain_names(name, value)
    if isinstance(value, Lamp):
        hint = (
            "build under an illuminant of colour-science, and give the lamp as one of "
            "the lights"
        )
        raise OptionError(
            f"{name} must be a name, which a cube records, got the lamp '{value}'",
            hint=hint,
        )
    if name == "dim" and isinstance(value, str) and value == AUTO:
        return AUTO
    accepted, recorded, label = TYPES[kind]
    if not isinstance(value, accepted) or (
        isinstance(value, bool) and recorded is not bool
    ):
        raise OptionError(f"{name} must be {label}, got {format_value(value)}")
    try:
        return recorded(value)
    except OverflowError:  # a whole number beyond all floats
        return np.inf


def _plain_names(name: str, value: Any) -> tuple[Any, ...]:
    """Return one or several names, and lamps if they are lights."""
    if isinstance(value, str | Lamp):
        value = [value]
    if not isinstance(value, Iterable):
        raise OptionError(f"{name} must be names, got {format_value(value)}")
    return tuple(
        item if isinstance(item, Lamp) and name == "lights" else _plain(name, str, item)
        for item in value
    )


def check_memory(options: Options) -> None:
    """Raise `OptionError` if the lattice does not fit into the memory of
    this machine.
    """
    if not isinstance(options.dim, int):
        return
    # Peak memory of a node: multipliers, and coefficients in single precision, and the
    # other arrays.
    node = 16 * options.spectrum_model().count + 60
    largest = int(
        max(((machine.free_memory() or 0) - machine.PROCESS_BYTES) / node, 8) ** (1 / 3)
    )
    hint = (
        f"use dim={largest} or less"
        if largest > 2
        else "use a machine with more memory"
    )
    need = (
        machine.PROCESS_BYTES + min(options.dim, 10**90) ** 3 * node
    )  # a float overflows for absurd values of dim
    machine.check_memory(need, "a lattice of this dim", OptionError, hint)
