"""Build options and their validation."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, fields, replace
from numbers import Integral, Real
from typing import Any, Literal, TypedDict, get_args

import numpy as np

from uplift.colorimetry.camera import CAMERA, Camera
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
from uplift.models.model import Model
from uplift.models.moments import MAX_COUNT, Moments
from uplift.models.sigmoid import Sigmoid

AUTO: Literal["auto"] = "auto"
OUTWARD = "outward"
LEAST_CHANGE = "least-change"
"""The solver of nodes by default."""
CUSTOM = "custom"
"""Recorded in place of a solver that was given as an object, and cannot be repeated."""
MAX_AUTO_TOLERANCE = 100.0
"""ΔE00 between black and white."""
STEPS = (1.0, 5.0, 10.0)
"""Steps of the sensor's wavelengths in nm."""
Dim = int | Literal["auto"]
Axis = Literal["srgb", "linear"]
ModelName = Literal["moments", "sigmoid"]
WarpName = Literal["none", "vision", "colour"]
PriorName = Literal["learnt", "smooth"]
NeutralName = Literal["expected", "flat"]
GrowthName = Literal["outward", "coarse-to-fine", "neighbours"]
SolverName = Literal["least-change", "dogleg", "levenberg-marquardt", "gauss-newton"]
CHOICES = {
    "model": ModelName,
    "axis": Axis,
    "prior": PriorName,
    "neutral": NeutralName,
    "growth": GrowthName,
    "solver": SolverName,
}
"""Options that have a choice of names."""
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

    Parameters
    ----------
    dim : int or {"auto"}, default 32
        Nodes along each axis, at least 2. ``"auto"`` chooses the smallest lattice, and
        its axis, that keeps every atlas entry within ``auto_tolerance``.
    model : {"moments", "sigmoid"}, default "moments"
        Spectrum model: bounded trigonometric moments, or the sigmoid of a quadratic.
    coefficients : int, default 9
        Coefficients per spectrum of the moment model, 3 to 17: the number of moments
        plus one. The sigmoid has 3.
    entry_coefficients : int, default 17
        Coefficients of the spectra of atlas entries in the moment model, from
        ``coefficients`` to 17. Entries are few, so more of them cost little, and the
        answers at and near the colours of entries come closer to the measurements.
    warp : {"none", "vision", "colour"}, default "none"
        Map from wavelengths to the phase of the moments. ``"vision"`` resolves
        wavelengths by the sensitivity of the eye.
    axis : {"srgb", "linear"}, default "srgb"
        Spacing of the axis nodes: equal steps of the sRGB encoding, or of linear RGB.
    space : str, default "sRGB"
        RGB space of queries, by its name in colour-science, or ``"camera"``: raw values
        of a camera, balanced so that a perfect white under the illuminant is (1, 1, 1).
    illuminant : str, default "D65"
        Illuminant under which reflectances have their RGB.
    observer : str or Camera, default "CIE 1931 2 Degree Standard Observer"
        Colour-matching functions, by their name in colour-science. With
        ``space="camera"`` a camera: its name in colour-science, a CSV file of its
        sensitivities, or a `Camera`.
    shortest, longest : float, default 380 and 780
        Range of the spectra in nm, at most 300 to 1000. Outside the range of an entry,
        its spectrum continues as a constant, and so does the learnt prior outside 380
        to 780; outside the range of the cube, every spectrum does. The coefficients are
        shared by the whole range, so a much wider one resolves less (docs/accuracy.md).
    step : {1, 5, 10}, default 5
        Distance in nm of the wavelengths at which spectra are integrated and compared.
    lights : sequence of str or Lamp, default ("D65", "A", "FL2", "FL11", "LED-B3")
        Illuminants under which fitted atlas entries must keep their measured colours.
    prior : {"learnt", "smooth"}, default "learnt"
        Spectra of colours that no entry constrains: those expected of real materials,
        or smooth ones.
    neutral : {"expected", "flat"}, default "expected"
        Spectra of colours with equal components: as of all other colours, or flat,
        fading to those expected of real materials from a CIE L*a*b* chroma of 4 to 12.
        Entries keep their measured spectra.
    leave_out : sequence of str, optional
        Families of the shipped library that the learnt prior must not know, for tests
        on them.
    threshold : float, default 1e-4
        Largest ``|target − stored|`` of a fitted node in linear RGB, in (0, 0.1].
    auto_tolerance : float, default 0.5
        With ``dim="auto"``: largest ΔE00, under ``lights``, between an entry and a
        lattice whose nodes around each entry start from it, which so has room for all.
    seed_corners : bool, default False
        Start all eight corners of the cell of each atlas entry from the entry, as
        Tódová 2020 does. By default, they start between entry and prior, and nearer to
        the prior at colours unlike the entry's and where other entries are close.
        ``growth="neighbours"`` always does.
    trust_atlas : bool, default False
        Expect every material to be like those of the atlas. By default the prior trusts
        an atlas only as far as its own entries are the better predicted, so that it
        does not mislead about other materials (docs/prior.md).
    exact_entries : bool, default False
        Keep the exact spectra of entries that contradict their surroundings. By default
        they are smoothed where they would show as spots under other lights, and nodes
        near entries are moved towards their neighbours where gradients would be steep.
    growth : {"outward", "coarse-to-fine", "neighbours"}, default "outward"
        Order in which nodes are fitted: outward from the atlas entries, in shells, or
        from a coarse lattice to finer ones. Both start from the spectrum that the atlas
        lets expect at a colour, and have the same answers. ``"neighbours"`` goes
        outward and starts from the spectra of fitted neighbours (Tódová 2020, section
        3.1).
    solver : str or optimistix.AbstractLeastSquaresSolver, default "least-change"
        Solver of nodes, all of optimistix: ``"least-change"``, our own, ``"dogleg"``,
        ``"levenberg-marquardt"``, ``"gauss-newton"``, or any least-squares solver or
        minimiser. The default is fastest; answers agree except for nearly box-shaped
        spectra (docs/accuracy.md).
    debug : bool, default False
        Store the round of growth in which each node was fitted.

    Raises
    ------
    OptionError
        A value of another type, or outside its range.
    UnknownNameError
        An unknown model, warp, axis, prior, growth or solver.
    """

    dim: Dim = 32
    model: str = "moments"
    coefficients: int = 9
    entry_coefficients: int = MAX_COUNT
    warp: str = "none"
    axis: str = "srgb"
    space: str = "sRGB"
    illuminant: str = DEFAULT_ILLUMINANT
    observer: str | Camera = DEFAULT_OBSERVER
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
    growth: str = OUTWARD
    solver: Any = LEAST_CHANGE
    debug: bool = False

    def __post_init__(self) -> None:
        for field in fields(self):
            value = _plain(field.name, field.type, getattr(self, field.name))
            object.__setattr__(self, field.name, value)
        for problem, hint in self._faults():
            raise OptionError(problem, hint=hint)
        for option, choice in CHOICES.items():
            value = getattr(self, option)
            known = get_args(choice)
            if isinstance(value, str) and value not in (*known, CUSTOM):
                raise unknown_name(value, known, option)
        self.spectrum_model()  # which checks the coefficients and the warp

    def _faults(self) -> Iterator[tuple[str, str]]:
        """Yield problems of the values, with hints. The first one counts."""
        shortest = self.shortest
        longest = self.longest
        low, high = RANGE
        if not low <= shortest <= START < END <= longest <= high:
            limits = (
                f"the range must hold {START:g} to {END:g} nm and lie within {low:g} "
                f"to {high:g} nm"
            )
            yield f"{limits}, got {shortest:g} to {longest:g}", ""
        # A rebuild has the sensitivities of a camera at the wavelengths of the cube
        # only.
        steps = [step for step in STEPS if step <= STEP or self.space != CAMERA]
        if self.step not in steps:
            allowed = ", ".join(f"{step:g}" for step in steps)
            problem = f"step of {self.space} must be one of {allowed} nm"
            yield f"{problem}, got {self.step:g}", "use 5"
        elif (longest - shortest) % self.step != 0:
            problem = f"the range must be a multiple of the step of {self.step:g} nm"
            yield f"{problem}, got {shortest:g} to {longest:g}", "use a step of 1"
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
        """Convert the options to JSON values, which a cube records. Lamps have their
        power.

        Returns
        -------
        dict of str to Any
            Values by name.
        """
        observer = self.observer
        named = replace(
            self,
            observer=observer.name if isinstance(observer, Camera) else observer,
            solver=self.solver if isinstance(self.solver, str) else CUSTOM,
        )
        return {
            name: list(value) if isinstance(value, tuple) else value
            for name, value in asdict(named).items()
        }

    def spectrum_model(self, coefficients: int | None = None) -> Model:
        """Create the spectrum model, from `shortest` to `longest` nm.

        Parameters
        ----------
        coefficients : int, optional
            Coefficients of moments, those of nodes by default.

        Returns
        -------
        Model
        """
        if self.model == Sigmoid.name:
            return Sigmoid(self.shortest, self.longest)
        count = self.coefficients if coefficients is None else coefficients
        return Moments(count, self.shortest, self.longest, self.warp)

    @property
    def learns_families(self) -> bool:
        """Whether the prior learns from families of measured materials."""
        return self.prior == "learnt" and not self.spectrum_model().is_determined


class OptionKeywords(TypedDict, total=False):
    """The fields of `Options` as keywords of a function, for editors and mypy."""

    dim: Dim
    model: ModelName
    coefficients: int
    entry_coefficients: int
    warp: WarpName
    axis: Axis
    space: str
    illuminant: str
    observer: str | Camera
    shortest: float
    longest: float
    step: float
    lights: Sequence[Illuminant]
    prior: PriorName
    neutral: NeutralName
    leave_out: Sequence[str]
    threshold: float
    auto_tolerance: float
    seed_corners: bool
    trust_atlas: bool
    exact_entries: bool
    growth: GrowthName
    solver: Any
    debug: bool


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
    if kind is Any or (name == "observer" and isinstance(value, Camera)):
        return value
    if isinstance(value, Lamp):
        hint = (
            "build under an illuminant of colour-science, and give the lamp as one of "
            "the lights"
        )
        problem = f"{name} must be a name, which a cube records, got the lamp '{value}'"
        raise OptionError(problem, hint=hint)
    if name == "dim" and isinstance(value, str) and value == AUTO:
        return AUTO
    accepted, recorded, label = TYPES.get(kind, TYPES[str])
    is_flag = isinstance(value, bool) and recorded is not bool
    if is_flag or not isinstance(value, accepted):
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
    if options.dim == AUTO:
        return
    # Peak memory of a node: multipliers, and coefficients in single precision, and the
    # other arrays.
    node = 16 * options.spectrum_model().count + 60
    free = (machine.free_memory() or 0) - machine.PROCESS_BYTES
    largest = int(max(free / node, 8) ** (1 / 3))
    hint = "use a machine with more memory"
    if largest > 2:
        hint = f"use dim={largest} or less"
    # A float overflows for absurd values of dim.
    need = machine.PROCESS_BYTES + min(options.dim, 10**90) ** 3 * node
    machine.check_memory(need, "a lattice of this dim", OptionError, hint)
