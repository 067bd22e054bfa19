"""Error and cost of representations: products of lights and surfaces against densely sampled ones.

Measured reflectances under sets of lights, with the statistics of Kment 2011, section 5.4."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, astuple, dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas import Atlas, merge, on_grid
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.colorimetry.lights import KMENT_LIGHTS
from uplift.common.arrays import Array
from uplift.common.errors import AtlasError, OptionError, UpliftError
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.lab.timing import Spread, environment, time_calls
from uplift.scene.representations.samples import STEP, Representation, wavelengths, xyz_weights

NAMED_SET = "given"
"""Name of the set of lights that a user lists."""
QUICK_SURFACES = 40
"""Surfaces of a quick comparison."""


@dataclass(frozen=True, eq=False)
class LightSet:
    """A set of lights.

    ``name``: name of the set.
    ``lights``: names of K lights.
    ``powers`` (K, 401): their relative powers, of luminance 1.
    """

    name: str
    lights: tuple[str, ...]
    powers: Array

    @property
    def title(self) -> str:
        """Return the name of the set with those of its lights."""
        return f"{self.name} lights ({', '.join(self.lights)})"

    @cached_property
    def whites(self) -> Array:
        """Return XYZ of the lights, (K, 3)."""
        return self.powers @ xyz_weights()

    def lab(self, xyz: Array) -> Array:
        """Convert XYZ to L*a*b*, relative to the white of each light. Shapes: ``xyz`` (K, E, 3); result (K, E, 3)."""
        return lab(xyz / self.whites[:, None], np.ones(3))


@dataclass(frozen=True, eq=False)
class Scene:
    """Surfaces and the sets of lights that illuminate them.

    ``names``: names of E surfaces.
    ``surfaces`` (E, 401): their reflectances.
    ``sets``: sets of lights.
    """

    names: tuple[str, ...]
    surfaces: Array
    sets: tuple[LightSet, ...]

    @property
    def powers(self) -> Array:
        """Return the powers of all lights, (L, 401)."""
        return np.concatenate([light_set.powers for light_set in self.sets])

    def reference(self, light_set: LightSet) -> Array:
        """Compute the colours of all surfaces from densely sampled products. The result has shape (K, E, 3)."""
        return light_set.lab((light_set.powers[:, None] * self.surfaces) @ xyz_weights())

    def thinned(self, count: int = QUICK_SURFACES) -> Scene:
        """Select at most ``count`` surfaces, evenly spaced."""
        kept = np.unique(np.linspace(0, len(self.names) - 1, count).round().astype(np.intp))
        return replace(self, names=tuple(self.names[row] for row in kept), surfaces=self.surfaces[kept])


def make_scene(atlases: Mapping[str, Atlas], lights: Sequence[str] = ()) -> Scene:
    """Combine the entries of atlases with sets of lights. Raises `AtlasError`, `UnknownNameError`."""
    merged = merge(atlases.values())
    if not merged.entries:
        raise AtlasError("the atlases have no entries", code="no-entries", hint="give an atlas of reflectances")
    named = {NAMED_SET: tuple(dict.fromkeys(lights))} if lights else KMENT_LIGHTS
    sets = tuple(LightSet(name, members, _powers(members)) for name, members in named.items())
    return Scene(merged.names, on_grid(merged, wavelengths()), sets)


def _powers(names: Sequence[str]) -> Array:
    powers = np.stack([observer.illuminant_spd(name, step=STEP) for name in names])
    return np.asarray(powers / (powers @ xyz_weights()[:, 1:2]))


HEADINGS = ("mean", "σ", "median", "2.5 %", "25 %", "75 %", "97.5 %")
"""Headings of tables, in the order of `Statistics`."""


@dataclass(frozen=True)
class Statistics:
    """Statistics of ΔE00.

    ``mean``, ``deviation``, ``median``: mean, standard deviation and median.
    ``q2_5``, ``q25``, ``q75``, ``q97_5``: quantiles of 2.5, 25, 75 and 97.5 %.
    """

    mean: float
    deviation: float
    median: float
    q2_5: float
    q25: float
    q75: float
    q97_5: float

    def __iter__(self) -> Iterator[float]:
        return iter(astuple(self))


def compute_statistics(errors: ArrayLike) -> Statistics:
    """Compute the statistics of errors."""
    values = np.asarray(errors, dtype=float).ravel()
    low, first, median, third, high = np.quantile(values, (0.025, 0.25, 0.5, 0.75, 0.975)).tolist()
    return Statistics(float(values.mean()), float(values.std()), median, low, first, third, high)


@dataclass(frozen=True)
class TimingOptions:
    """Accuracy of the timings.

    ``runs``: repetitions.
    ``seconds``: shortest duration of a run.
    ``rows``: products per call.
    """

    runs: int = 7
    seconds: float = 0.05
    rows: int = 1024


QUICK = TimingOptions(runs=3, seconds=0.005, rows=256)


@dataclass(frozen=True)
class RepresentationResult:
    """Error and cost of a representation under a set of lights.

    ``name``, ``family``: name and family of the representation.
    ``lights``: name of the set of lights.
    ``statistics``: ΔE00 between its products and the dense ones.
    ``floats``, ``light_floats``: mean storage of a surface and of a light.
    ``ns``: CPU time of all threads per product, of many products per call.
    """

    name: str
    family: str
    lights: str
    statistics: Statistics
    floats: float
    light_floats: float
    ns: Spread


@dataclass(frozen=True)
class Comparison:
    """Results of several representations.

    ``facts``: machine, versions and size of the comparison.
    ``sets``: titles of the sets of lights by name.
    ``results``: ranked by mean error within each set.
    """

    facts: Mapping[str, str]
    sets: Mapping[str, str]
    results: tuple[RepresentationResult, ...]

    def of(self, name: str) -> tuple[RepresentationResult, ...]:
        """Return the results under a set of lights."""
        return tuple(result for result in self.results if result.lights == name)


def compare(
    scene: Scene,
    representations: Sequence[Representation],
    effort: TimingOptions | None = None,
    progress: ProgressCallback = ignore_progress,
) -> Comparison:
    """Measure representations under every set of lights of a scene. Raises `UpliftError`."""
    references = [scene.reference(light_set) for light_set in scene.sets]
    results = []
    for done, representation in enumerate(representations, 1):
        surfaces = representation.encode_surface(scene.surfaces)
        times = _times(representation, scene, effort or TimingOptions())
        results += [
            _result(representation, surfaces, light_set, scene, reference, ns)
            for light_set, reference, ns in zip(scene.sets, references, times, strict=True)
        ]
        progress(Progress("representations", done, len(representations)))
    order = [light_set.name for light_set in scene.sets]
    ranked = sorted(results, key=lambda result: (order.index(result.lights), result.statistics.mean))
    facts = {**environment(), "products": f"{len(scene.names)} surfaces under each light"}
    return Comparison(facts, {light_set.name: light_set.title for light_set in scene.sets}, tuple(ranked))


def error_statistics(representation: Representation, scene: Scene, light_set: LightSet) -> Statistics:
    """Compute the errors of a representation under a set of lights. Raises `UpliftError`."""
    surfaces = representation.encode_surface(scene.surfaces)
    return compute_statistics(_errors(representation, surfaces, light_set, scene, scene.reference(light_set)))


def _errors(
    representation: Representation, surfaces: Any, light_set: LightSet, scene: Scene, reference: Array
) -> Array:
    """ΔE00 (K, E) of encoded ``surfaces`` under each light of a set."""
    rows = len(scene.names)
    xyz = [
        representation.xyz(representation.multiply(_repeat_light(representation, power, rows), surfaces))
        for power in light_set.powers
    ]
    errors = delta_e_2000(light_set.lab(np.stack(xyz)), reference)
    if not np.isfinite(errors).all():
        raise UpliftError(
            f"{representation.name} returns values that are not finite under {light_set.title}",
            code="result-not-finite",
        )
    return errors


def _result(
    representation: Representation,
    surfaces: Any,
    light_set: LightSet,
    scene: Scene,
    reference: Array,
    ns: Spread,
) -> RepresentationResult:
    return RepresentationResult(
        name=representation.name,
        family=representation.family,
        lights=light_set.name,
        statistics=compute_statistics(_errors(representation, surfaces, light_set, scene, reference)),
        floats=float(representation.storage(surfaces).mean()),
        light_floats=float(representation.storage(representation.encode_light(light_set.powers)).mean()),
        ns=ns,
    )


def _times(representation: Representation, scene: Scene, effort: TimingOptions) -> list[Spread]:
    """CPU time of a product, in ns, for each set: each of its lights in turn, with many surfaces per call."""
    surfaces = np.resize(scene.surfaces, (effort.rows, scene.surfaces.shape[1]))
    encoded = representation.encode_surface(surfaces)
    return [_time(representation, encoded, light_set, effort) for light_set in scene.sets]


def _time(representation: Representation, surfaces: Any, light_set: LightSet, effort: TimingOptions) -> Spread:
    lights = [_repeat_light(representation, power, effort.rows) for power in light_set.powers]

    def multiply(laps: int) -> None:
        for light in lights * laps:
            representation.multiply(light, surfaces)

    multiply(1)
    _, once = time_calls(lambda: multiply(1), 1)
    laps = max(1, round(effort.seconds / max(once.median, 1e-6)))
    _, cpu = time_calls(lambda: multiply(laps), effort.runs)
    return cpu.scaled(1e9 / (laps * len(lights) * effort.rows))


def _repeat_light(representation: Representation, power: Array, rows: int) -> Any:
    return representation.encode_light(np.broadcast_to(power, (rows, len(power))))


def check_target(target: float) -> float:
    """Check the largest ΔE00 that a representation may have. Raises `OptionError`."""
    if not (math.isfinite(target) and target > 0):
        raise OptionError(f"target must be a positive ΔE00, got {target:g}", code="target-not-positive")
    return target


def cheapest(comparison: Comparison, lights: str, target: float) -> RepresentationResult | None:
    """Choose the representation that stores least among those accurate enough under a set of lights.

    Of equally small ones the smaller light, then the smaller error decides. Times are not considered: among
    representations of equal size they depend on other work of the machine.

    Raises `OptionError`.
    """
    check_target(target)
    sufficient = [result for result in comparison.of(lights) if result.statistics.q97_5 <= target]
    return min(
        sufficient,
        key=lambda result: (result.floats, result.light_floats, result.statistics.q97_5),
        default=None,
    )


def most_accurate(comparison: Comparison, lights: str) -> RepresentationResult:
    """Choose the representation of the smallest 97.5 % quantile under a set of lights."""
    return min(comparison.of(lights), key=lambda result: result.statistics.q97_5)


def records(comparison: Comparison) -> list[dict[str, Any]]:
    """Convert the results of a comparison to records."""
    return [_record(result) for result in comparison.results]


def _record(result: RepresentationResult) -> dict[str, Any]:
    return {
        "lights": result.lights,
        "representation": result.name,
        "family": result.family,
        **asdict(result.statistics),
        "floats": result.floats,
        "light_floats": result.light_floats,
        "ns": result.ns.median,
        "ns_least": result.ns.min,
        "ns_most": result.ns.max,
    }
