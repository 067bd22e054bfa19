"""Error and cost of representations: products of lights and surfaces against densely
sampled ones.

Measured reflectances under sets of lights, with the statistics of Kment 2011, section
5.4.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from operator import itemgetter
from typing import Any

import numpy as np

from uplift.atlas.atlas import Atlas, Entry, merge
from uplift.atlas.resampling import on_grid
from uplift.colorimetry.delta_e import delta_e_2000
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
from uplift.common.progress import ProgressCallback, ignore_progress, reported
from uplift.common.text import pluralise
from uplift.extras.colour.light_sets import KMENT_LIGHTS
from uplift.extras.papers.representations import samples
from uplift.extras.papers.representations.samples import Representation
from uplift.extras.papers.wavelengths.sampling import RenderSetup, make_setup
from uplift.extras.timing import TimingStats, environment, time_short_call

Row = dict[str, Any]
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

    @property
    def illuminants(self) -> list[Illuminant]:
        """Return all lights."""
        return list(chain.from_iterable(each.illuminants for each in self.sets))

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
    named = {"given": lights} if lights else KMENT_LIGHTS
    surfaces = on_grid(merged, samples.wavelengths())
    weights = samples.xyz_weights()
    sets = []
    for name, members in named.items():
        setup = make_setup(surfaces, members, wavelengths=samples.wavelengths())
        powers = setup.powers / (setup.powers @ weights[:, 1:2])
        of_lights = setup.lights, powers, weights, setup.illuminants
        sets.append(LightSet(setup.wavelengths, surfaces, *of_lights, name))
    return Scene(tuple(sets))


QUANTILES = {"q2_5": 2.5, "q25": 25, "q75": 75, "q97_5": 97.5}
"""Percentages of ΔE00 by the name of their quantile in tables."""
HEADINGS = {"mean": "mean", "deviation": "σ", "median": "median"} | {
    name: f"{share:g} %" for name, share in QUANTILES.items()
}
"""Statistics of ΔE00 with their headings in tables."""


@dataclass(frozen=True)
class Comparison:
    """Results by mean error in each set of lights, and ``facts`` of the machine.

    ``sets``: titles of the sets by name. ``rows``: ``lights``, the name of a set;
    ``representation`` and its ``family``; `HEADINGS`, the statistics of ΔE00 between
    its products and the dense ones; ``floats`` and ``light_floats``, the mean storage
    of a surface and of a light; ``ns``, the CPU time of all threads per product, of
    many products per call, with its range.
    """

    facts: Mapping[str, str]
    sets: Mapping[str, str]
    rows: Sequence[Row]

    def of(self, name: str) -> list[Row]:
        """Return the rows of a set of lights."""
        return [row for row in self.rows if row["lights"] == name]


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
    rows: list[Row] = []
    for representation in reported(representations, "representations", progress):
        for light_set in scene.sets:
            floats = representation.numbers(light_set.powers, scene.surfaces)
            errors = error_statistics(representation, light_set)
            ns = _time(representation, light_set, quick)
            rows.append(
                {
                    "lights": light_set.name,
                    "representation": representation.name,
                    "family": representation.family,
                    **errors,
                    "floats": floats[1],
                    "light_floats": floats[0],
                    "ns": ns.median,
                    "ns_least": ns.min,
                    "ns_most": ns.max,
                }
            )
    sets = {light_set.name: light_set.title for light_set in scene.sets}
    order = list(sets)
    rows.sort(key=lambda row: (order.index(row["lights"]), row["mean"]))
    products = f"{pluralise(len(scene.surfaces), 'surface')} under each light"
    return Comparison({**environment(), "products": products}, sets, rows)


def represent(
    representation: Representation, scene: Scene, names: Sequence[str]
) -> tuple[Atlas, Atlas]:
    """Return the surfaces of a scene, with ``names``, and its lights as a
    representation stores them.

    The largest power of a light is 1. Spectra that leave [0, 1], as those of lines
    after a filter with negative lobes, are clipped with a warning. Raises
    `UpliftError`.
    """
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
        nm = [samples.wavelengths()] * len(names)
        return Atlas(tuple(map(Entry, names, nm, clipped)))

    lights = list(map(str, scene.illuminants))
    return atlas(names, surfaces), atlas(
        lights, powers / powers.max(axis=1, keepdims=True)
    )


def error_statistics(
    representation: Representation, light_set: LightSet
) -> dict[str, float]:
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
    found = [errors.mean(), errors.std(), np.median(errors)]
    found += np.percentile(errors, list(QUANTILES.values())).tolist()
    return dict(zip(HEADINGS, map(float, found), strict=True))


def _time(
    representation: Representation, light_set: LightSet, quick: bool
) -> TimingStats:
    """CPU time of a product, in ns: each light of a set in turn, with many surfaces per
    call.
    """
    count, lap, runs = QUICK_TIMING if quick else TIMING
    spectra = np.resize(light_set.reflectances, (count, len(light_set.wavelengths)))
    surfaces = representation.encode_surface(spectra)
    lights = [
        representation.encode_light(np.broadcast_to(power, spectra.shape))
        for power in light_set.powers
    ]

    def multiply() -> None:
        for light in lights:
            representation.multiply(light, surfaces)

    timing = time_short_call(multiply, lap, runs)
    return timing.cpu.scaled(1e9 / (len(lights) * count))


def check_target(target: float) -> None:
    """Check the largest ΔE00 that a representation may have. Raises `OptionError`."""
    if not 0 < target < np.inf:
        raise OptionError(f"target must be a positive ΔE00, got {target:g}")


COSTS = itemgetter("floats", "light_floats", "q97_5")
"""Floats of a surface and of a light, and the error of 97.5 %."""


def cheapest(rows: Iterable[Row], target: float) -> Row | None:
    """Choose the representation that stores least among those accurate enough.

    Of equally small ones the smaller light, then the smaller error decides. Times are
    not considered: among representations of equal size they depend on other work of the
    machine. Raises `OptionError`.
    """
    check_target(target)
    accurate = [row for row in rows if row["q97_5"] <= target]
    return min(accurate, key=COSTS, default=None)


def pareto(rows: Sequence[Row]) -> list[Row]:
    """Return the rows that no other dominates in both floats and error of 97.5 %."""
    front: list[Row] = []
    # What dominates a row comes before it.
    for row in sorted(rows, key=COSTS):
        if not any(_dominates(other, row) for other in front):
            front.append(row)
    return [row for row in rows if row in front]


def _dominates(row: Row, other: Row) -> bool:
    """Whether a row is nowhere larger than another."""
    pairs = zip(COSTS(row), COSTS(other), strict=True)
    return all(first <= second for first, second in pairs)
