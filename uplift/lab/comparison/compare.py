"""Error and cost of representations: products of lights and surfaces against densely
sampled ones.

Measured reflectances under sets of lights, with the statistics of Kment 2011, section
5.4.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas import Atlas, Entry, merge, on_grid
from uplift.colorimetry import delta_e_2000, observer
from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.sensor import SLACK
from uplift.common.arrays import Array
from uplift.common.errors import (
    AtlasError,
    OptionError,
    UpliftError,
    UpliftWarning,
    warn,
)
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.common.text import pluralise
from uplift.extras.colour.light_sets import KMENT_LIGHTS
from uplift.extras.scene.plan.candidates import front
from uplift.extras.scene.representations import samples
from uplift.extras.scene.representations.samples import Representation
from uplift.extras.scene.wavelengths.sampling import RenderSetup
from uplift.lab.timing import TimingStats, environment, time_laps

TIMING = (1024, 0.05, 7)
QUICK_TIMING = (256, 0.005, 3)
"""Products per call, shortest duration of a run in seconds, and runs."""


@dataclass(frozen=True, eq=False)
class LightSet(RenderSetup):
    """Surfaces under a set of lights of luminance 1, as dense spectra."""

    name: str

    @property
    def title(self) -> str:
        """Return the name of the set with those of its lights."""
        return f"{self.name} lights ({', '.join(self.lights)})"


@dataclass(frozen=True, eq=False)
class Scene:
    """The same surfaces under several sets of lights."""

    sets: tuple[LightSet, ...]

    @property
    def surfaces(self) -> Array:
        """Return the reflectances (E, 401)."""
        return self.sets[0].reflectances

    @property
    def powers(self) -> Array:
        """Return the powers of all lights, (L, 401)."""
        return np.concatenate([light_set.powers for light_set in self.sets])

    def thinned(self, count: int = 40) -> "Scene":
        """Select at most ``count`` surfaces, evenly spaced."""
        rows = np.linspace(0, len(self.surfaces) - 1, count).round().astype(np.intp)
        kept = self.surfaces[np.unique(rows)]
        return Scene(
            tuple(replace(light_set, reflectances=kept) for light_set in self.sets)
        )


def make_scene(
    atlases: Mapping[str, Atlas], lights: Sequence[Illuminant] = ()
) -> Scene:
    """Combine the entries of atlases with sets of lights. Raises `AtlasError`,
    `UnknownNameError`.
    """
    merged = merge(atlases.values())
    if not merged.entries:
        raise AtlasError(
            "the atlases have no entries", hint="give an atlas of reflectances"
        )
    observer.check_distinct(lights)
    named: Mapping[str, tuple[Illuminant, ...]] = KMENT_LIGHTS
    if lights:
        named = {"given": tuple(dict.fromkeys(lights))}
    nm = samples.wavelengths()
    weights = samples.xyz_weights()
    surfaces = on_grid(merged, nm)
    sets = []
    for name, members in named.items():
        spectra = [
            observer.illuminant_spd(member, step=samples.STEP) for member in members
        ]
        powers = np.stack(spectra)
        powers /= powers @ weights[:, 1:2]
        labels = tuple(map(str, members))
        sets.append(LightSet(nm, surfaces, labels, powers, weights, members, name))
    return Scene(tuple(sets))


HEADINGS = ("mean", "σ", "median", "2.5 %", "25 %", "75 %", "97.5 %")
"""Headings of tables, in the order of `Statistics`."""


class Statistics(NamedTuple):
    """Mean, standard deviation, median and four quantiles in percent of ΔE00."""

    mean: float
    deviation: float
    median: float
    q2_5: float
    q25: float
    q75: float
    q97_5: float


def compute_statistics(errors: ArrayLike) -> Statistics:
    """Compute the statistics of errors."""
    values = np.asarray(errors, dtype=float).ravel()
    low, first, median, third, high = np.quantile(
        values, (0.025, 0.25, 0.5, 0.75, 0.975)
    ).tolist()
    return Statistics(
        float(values.mean()), float(values.std()), median, low, first, third, high
    )


@dataclass(frozen=True)
class RepresentationResult:
    """Error and cost of a representation under a set of lights.

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
    ns: TimingStats


@dataclass(frozen=True)
class Comparison:
    """Results by mean error in each set of lights, and ``facts`` of the machine.

    ``sets``: titles of the sets by name.
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
    *,
    quick: bool = False,
    progress: ProgressCallback = ignore_progress,
) -> Comparison:
    """Measure representations under all lights of a scene; ``quick`` repeats less.

    Raises `UpliftError`.
    """
    sets = {light_set.name: light_set.title for light_set in scene.sets}
    results = []
    for done, representation in enumerate(representations, 1):
        for light_set in scene.sets:
            light_floats, floats = representation.numbers(
                light_set.powers, scene.surfaces
            )
            errors = error_statistics(representation, light_set)
            ns = _time(representation, light_set, quick)
            names = representation.name, representation.family, light_set.name
            results.append(
                RepresentationResult(*names, errors, floats, light_floats, ns)
            )
        progress(Progress("representations", done, len(representations)))
    order = list(sets)
    results.sort(
        key=lambda result: (order.index(result.lights), result.statistics.mean)
    )
    facts = {
        **environment(),
        "products": f"{pluralise(len(scene.surfaces), 'surface')} under each light",
    }
    return Comparison(facts, sets, tuple(results))


def represent(
    representation: Representation, scene: Scene, names: Sequence[str]
) -> tuple[Atlas, Atlas]:
    """Return the surfaces of a scene, with ``names``, and its lights as a
    representation stores them.

    The largest power of a light is 1. Spectra that leave [0, 1], as those of lines
    after a filter with negative lobes, are clipped with a warning. Raises
    `UpliftError`.
    """
    lights = list(chain.from_iterable(light_set.lights for light_set in scene.sets))
    powers, surfaces = representation.stored(scene.powers, scene.surfaces)

    def atlas(names: Sequence[str], spectra: Array) -> Atlas:
        clipped = np.clip(spectra, 0, 1)
        outside = (np.abs(spectra - clipped) > SLACK).any(axis=1).sum()
        if outside:
            problem = (
                f"{outside} of {len(names)} spectra leave [0, 1] as "
                f"{representation.name} and are clipped"
            )
            warn(UpliftWarning(problem, code="entry-clipped"))
        pairs = zip(names, clipped, strict=True)
        return Atlas(
            tuple(Entry(name, samples.wavelengths(), values) for name, values in pairs)
        )

    return atlas(names, surfaces), atlas(
        lights, powers / powers.max(axis=1, keepdims=True)
    )


def error_statistics(representation: Representation, light_set: LightSet) -> Statistics:
    """Compute the errors of a representation under a set of lights. Raises
    `UpliftError`.
    """
    xyz = representation.reflected(light_set.powers, light_set.reflectances)
    errors = delta_e_2000(light_set.to_lab(xyz), light_set.lab)
    if not np.isfinite(errors).all():
        raise UpliftError(
            f"{representation.name} returns values that are not finite under "
            f"{light_set.title}"
        )
    return compute_statistics(errors)


def _time(
    representation: Representation, light_set: LightSet, quick: bool
) -> TimingStats:
    """CPU time of a product, in ns: each light of a set in turn, with many surfaces per
    call.
    """
    rows, lap, runs = QUICK_TIMING if quick else TIMING
    spectra = np.resize(light_set.reflectances, (rows, len(light_set.wavelengths)))
    surfaces = representation.encode_surface(spectra)
    lights = [
        representation.encode_light(np.broadcast_to(power, spectra.shape))
        for power in light_set.powers
    ]

    def multiply() -> None:
        for light in lights:
            representation.multiply(light, surfaces)

    return time_laps(multiply, lap, runs).scaled(1e9 / (len(lights) * rows))


def check_target(target: float) -> float:
    """Check the largest ΔE00 that a representation may have. Raises `OptionError`."""
    if not (math.isfinite(target) and target > 0):
        raise OptionError(f"target must be a positive ΔE00, got {target:g}")
    return target


def cheapest(
    comparison: Comparison, lights: str, target: float
) -> RepresentationResult | None:
    """Choose the representation that stores least among those accurate enough under a
    set of lights.

    Of equally small ones the smaller light, then the smaller error decides. Times are
    not considered: among representations of equal size they depend on other work of the
    machine. Raises `OptionError`.
    """
    check_target(target)
    accurate = [
        result for result in comparison.of(lights) if result.statistics.q97_5 <= target
    ]
    return min(accurate, key=_costs, default=None)


def _costs(result: RepresentationResult) -> tuple[float, float, float]:
    """Return the floats of a surface and of a light, and the error of 97.5 %."""
    return result.floats, result.light_floats, result.statistics.q97_5


def pareto(comparison: Comparison, lights: str) -> list[RepresentationResult]:
    """Return the results that no other dominates in both floats and error of 97.5 %."""
    results = comparison.of(lights)
    costs = np.array(list(map(_costs, results)))
    return [results[row] for row in sorted(front(costs))]


def records(comparison: Comparison) -> list[dict[str, Any]]:
    """Convert the results of a comparison to records."""
    return [
        {
            "lights": result.lights,
            "representation": result.name,
            "family": result.family,
            **result.statistics._asdict(),
            "floats": result.floats,
            "light_floats": result.light_floats,
            "ns": result.ns.median,
            "ns_least": result.ns.min,
            "ns_most": result.ns.max,
        }
        for result in comparison.results
    ]
