"""Grid search for the low-pass filter before point sampling that leaves the smallest error.

Lights and surfaces are filtered alike.

References
----------
Kment 2011, section 6.3, tables A.1 and A.2.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from itertools import product
from typing import Any

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000
from uplift.common.arrays import Array
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.lab.comparison.compare import LightSet, Scene, Statistics, error_statistics
from uplift.scene.representations.filters import (
    FINE_STRIDE,
    KINDS,
    Filter,
    candidates,
    filtered_point_samples,
    resampling_matrix,
)
from uplift.scene.representations.samples import TABLE_STRIDE, point_samples

COUNTS = (4, 8, 16)
"""Numbers of samples in the thesis."""
NONE = "none"


@dataclass(frozen=True)
class TunedFilter:
    """The best filter of a kind.

    ``kind``: kind of the filter, ``none`` for unfiltered samples.
    ``count``: number of samples.
    ``lights``: name of the set of lights.
    ``low_pass``: the filter.
    ``statistics``: its errors.
    """

    kind: str
    count: int
    lights: str
    low_pass: Filter | None
    statistics: Statistics

    @property
    def parameters(self) -> str:
        """Return the filter's parameters as text."""
        if self.low_pass is None:
            return ""
        named = zip(KINDS[self.kind].choices, self.low_pass.parameters, strict=True)
        return ", ".join([f"extent {self.low_pass.extent}", *(f"{key} {value:g}" for key, value in named)])


def tune_filters(
    scene: Scene,
    stride: int = FINE_STRIDE,
    kinds: Sequence[str] = tuple(KINDS),
    counts: Sequence[int] = COUNTS,
    progress: ProgressCallback = ignore_progress,
) -> tuple[TunedFilter, ...]:
    """Search the best filter of each kind, for each number of samples and each set of lights."""
    results = [
        TunedFilter(NONE, count, light_set.name, None, error_statistics(point_samples(count), scene, light_set))
        for count in counts
        for light_set in scene.sets
    ]
    tasks = list(product(kinds, counts))
    for done, (kind, count) in enumerate(tasks, 1):
        for light_set, best in zip(scene.sets, _best(candidates(kind, stride), count, scene), strict=True):
            errors = error_statistics(filtered_point_samples(count, best), scene, light_set)
            results.append(TunedFilter(kind, count, light_set.name, best, errors))
        progress(Progress("filters", done, len(tasks)))
    return tuple(results)


def _best(filters: Sequence[Filter], count: int, scene: Scene) -> list[Filter]:
    """For each set of lights the filter of the smallest mean error."""
    mean_errors = [_mean_error(scene, light_set, count) for light_set in scene.sets]
    means = np.empty((len(filters), len(mean_errors)))
    for row, low_pass in enumerate(filters):
        encoder = resampling_matrix(low_pass, count).T
        means[row] = [mean_error(encoder) for mean_error in mean_errors]
    return [filters[int(row)] for row in means.argmin(axis=0)]


def _mean_error(scene: Scene, light_set: LightSet, count: int) -> Callable[[Array], float]:
    """Function from an encoder (81, count) of the 5 nm table to the mean ΔE00, faster than `error_statistics`."""
    surfaces, lights = scene.surfaces[:, ::TABLE_STRIDE], light_set.powers[:, ::TABLE_STRIDE]
    reference, weights = scene.reference(light_set), point_samples(count).weights

    def mean_error(encoder: Array) -> float:
        products = (lights @ encoder)[:, None] * (surfaces @ encoder)
        return float(delta_e_2000(light_set.lab(products @ weights), reference).mean())

    return mean_error


def filter_records(tuned: Iterable[TunedFilter]) -> list[dict[str, Any]]:
    """Convert tuned filters to records."""
    return [
        {"lights": each.lights, "samples": each.count, "filter": each.kind, "parameters": each.parameters}
        | asdict(each.statistics)
        for each in tuned
    ]
