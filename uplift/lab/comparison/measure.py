"""Error and cost of every representation: products of lights and surfaces against dense ones, and what they take."""

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
from uplift.lab.comparison.statistics import Statistics, statistics
from uplift.lab.timing import Spread, environment, timed
from uplift.scene.representations.representation import Representation


@dataclass(frozen=True)
class Effort:
    """``runs`` of at least ``lap`` seconds for a time, ``rows`` products at once."""

    runs: int = 7
    lap: float = 0.05
    rows: int = 1024


QUICK = Effort(runs=3, lap=0.005, rows=256)


@dataclass(frozen=True)
class RepresentationResult:
    """A representation under a set of lights.

    Parameters
    ----------
    name, family, lights : of the representation, and of the set.
    statistics : ΔE00 between its products and the dense ones.
    floats, light_floats : stored of a surface and of a light, in the mean.
    ns : CPU time of all threads for a product, of many at once.
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
    """Rows, ranked by mean error within each set; the ``sets`` by name, with their titles; ``facts`` of the run."""

    facts: Mapping[str, str]
    sets: Mapping[str, str]
    rows: tuple[RepresentationResult, ...]

    def of(self, name: str) -> tuple[RepresentationResult, ...]:
        """The rows of a set."""
        return tuple(row for row in self.rows if row.lights == name)


def compare(
    scene: Scene,
    representations: Sequence[Representation],
    effort: Effort | None = None,
    progress: ProgressCallback = ignore_progress,
) -> Comparison:
    """Every representation, under every set of lights. ``progress`` hears how many of how many are done.

    Raises
    ------
    UpliftError : a representation whose answers are not numbers.
    """
    references = [scene.reference(part) for part in scene.sets]
    rows = []
    for done, representation in enumerate(representations, 1):
        surfaces = representation.encode_surface(scene.surfaces)
        times = _times(representation, scene, effort or Effort())
        rows += [
            _row(representation, surfaces, part, scene, reference, ns)
            for part, reference, ns in zip(scene.sets, references, times, strict=True)
        ]
        progress(Progress("representations", done, len(representations)))
    order = [part.name for part in scene.sets]
    ranked = sorted(rows, key=lambda row: (order.index(row.lights), row.statistics.mean))
    facts = {**environment(), "products": f"{len(scene.names)} surfaces under each light"}
    return Comparison(facts, {part.name: part.title for part in scene.sets}, tuple(ranked))


def errors(
    representation: Representation, surfaces: Any, part: LightSet, scene: Scene, reference: Array
) -> Array:
    """ΔE00 (K, E) of encoded ``surfaces`` under each light of a set. Raises `UpliftError`."""
    seen = [
        representation.xyz(
            representation.multiply(_repeated(representation, power, len(scene.names)), surfaces)
        )
        for power in part.powers
    ]
    apart = delta_e_2000(part.lab(np.stack(seen)), reference)
    if not np.isfinite(apart).all():
        raise UpliftError(f"{representation.name} answers what is no number under {part.title}")
    return apart


def error_statistics(representation: Representation, scene: Scene, part: LightSet) -> Statistics:
    """The errors of a representation under a set of lights, and no cost. Raises `UpliftError`."""
    surfaces = representation.encode_surface(scene.surfaces)
    return statistics(errors(representation, surfaces, part, scene, scene.reference(part)))


def _row(
    representation: Representation, surfaces: Any, part: LightSet, scene: Scene, reference: Array, ns: Spread
) -> RepresentationResult:
    apart = errors(representation, surfaces, part, scene, reference)
    return RepresentationResult(
        name=representation.name,
        family=representation.family,
        lights=part.name,
        statistics=statistics(apart),
        floats=float(representation.storage(surfaces).mean()),
        light_floats=float(representation.storage(representation.encode_light(part.powers)).mean()),
        ns=ns,
    )


def _times(representation: Representation, scene: Scene, effort: Effort) -> list[Spread]:
    """CPU time of a product, in ns, for each set: of each of its lights in turn with many surfaces at once."""
    surfaces = representation.encode_surface(
        np.resize(scene.surfaces, (effort.rows, scene.surfaces.shape[1]))
    )
    return [_time(representation, surfaces, part, effort) for part in scene.sets]


def _time(representation: Representation, surfaces: Any, part: LightSet, effort: Effort) -> Spread:
    lights = [_repeated(representation, power, effort.rows) for power in part.powers]

    def laps(count: int) -> None:
        for light in lights * count:
            representation.multiply(light, surfaces)

    laps(1)
    _, once = timed(lambda: laps(1), 1)
    count = max(1, round(effort.lap / max(once.median, 1e-6)))
    _, cpu = timed(lambda: laps(count), effort.runs)
    return cpu.scaled(1e9 / (count * len(lights) * effort.rows))


def _repeated(representation: Representation, power: Array, rows: int) -> Any:
    return representation.encode_light(np.broadcast_to(power, (rows, len(power))))
