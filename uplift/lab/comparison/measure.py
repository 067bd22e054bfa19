"""Error and cost of representations: products of lights and surfaces against densely sampled ones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000
from uplift.common.arrays import Array
from uplift.common.errors import UpliftError
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.lab.comparison.scene import LightSet, Scene
from uplift.lab.comparison.statistics import Statistics, compute_statistics
from uplift.lab.timing import Spread, environment, time_calls
from uplift.scene.representations.samples import Representation


@dataclass(frozen=True)
class TimingOptions:
    """Accuracy of the timings.

    Parameters
    ----------
    runs : int
        Repetitions.
    seconds : float
        Shortest duration of a run.
    rows : int
        Products per call.
    """

    runs: int = 7
    seconds: float = 0.05
    rows: int = 1024


QUICK = TimingOptions(runs=3, seconds=0.005, rows=256)


@dataclass(frozen=True)
class RepresentationResult:
    """Error and cost of a representation under a set of lights.

    Parameters
    ----------
    name, family : str
        Name and family of the representation.
    lights : str
        Name of the set of lights.
    statistics : Statistics
        ΔE00 between its products and the dense ones.
    floats, light_floats : float
        Mean storage of a surface and of a light.
    ns : Spread
        CPU time of all threads per product, of many products per call.
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

    Parameters
    ----------
    facts : mapping of str to str
        Machine, versions and size of the comparison.
    sets : mapping of str to str
        Titles of the sets of lights by name.
    results : tuple of RepresentationResult
        Ranked by mean error within each set.
    """

    facts: Mapping[str, str]
    sets: Mapping[str, str]
    results: tuple[RepresentationResult, ...]

    def of(self, name: str) -> tuple[RepresentationResult, ...]:
        """Return the results under a set of lights.

        Parameters
        ----------
        name : str
            Name of the set.

        Returns
        -------
        tuple of RepresentationResult
            Its results, ranked by mean error.
        """
        return tuple(result for result in self.results if result.lights == name)


def compare(
    scene: Scene,
    representations: Sequence[Representation],
    effort: TimingOptions | None = None,
    progress: ProgressCallback = ignore_progress,
) -> Comparison:
    """Measure representations under every set of lights of a scene.

    Parameters
    ----------
    scene : Scene
        Surfaces and lights.
    representations : sequence of Representation
        The representations.
    effort : Effort, optional
        Accuracy of the timings.
    progress : callable, optional
        Called with a `Progress` after each representation.

    Returns
    -------
    Comparison
        The results, ranked.

    Raises
    ------
    UpliftError
        If a representation returns values that are not finite.
    """
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
    """Compute the errors of a representation under a set of lights.

    Parameters
    ----------
    representation : Representation
        The representation.
    scene : Scene
        The surfaces.
    light_set : LightSet
        The lights.

    Returns
    -------
    Statistics
        Statistics of ΔE00.

    Raises
    ------
    UpliftError
        If the representation returns values that are not finite.
    """
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
