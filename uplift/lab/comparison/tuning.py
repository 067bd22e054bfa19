"""Low-pass filters before point sampling that leave the smallest errors, by a grid
search (Kment 2011, section 6.3, tables A.1 and A.2); lights and surfaces are filtered
alike.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from uplift.colorimetry import delta_e_2000
from uplift.common.arrays import Array
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.extras.scene.representations import filters, samples
from uplift.extras.scene.representations.filters import Filter
from uplift.lab.comparison.compare import (
    LightSet,
    Scene,
    Statistics,
    error_statistics,
)

COUNTS = (4, 8, 16)
"""Numbers of samples after a filter in the thesis."""
NONE = "none"
FINE_STRIDE = 1
COARSE_STRIDE = 5
"""A search tries every first or every fifth choice of each parameter."""


@dataclass(frozen=True)
class TunedFilter:
    """The best filter of a kind, ``none`` for unfiltered samples, and its errors under
    a set of lights.
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
        text = f"extent {self.low_pass.extent}"
        names = filters.KINDS[self.kind].choices
        for name, value in zip(names, self.low_pass.parameters, strict=True):
            text += f", {name} {value:g}"
        return text


def candidates(kind: str, stride: int = FINE_STRIDE) -> list[Filter]:
    """Filters of a kind for a grid search over every ``stride``-th choice of each
    parameter.
    """
    choices = [values[::stride] for values in filters.KINDS[kind].choices.values()]
    combinations = product(filters.EXTENTS[::stride], product(*choices))
    return [Filter(kind, extent, values) for extent, values in combinations]


def tune_filters(
    scene: Scene,
    stride: int = FINE_STRIDE,
    kinds: Sequence[str] = tuple(filters.KINDS),
    counts: Sequence[int] = COUNTS,
    progress: ProgressCallback = ignore_progress,
) -> tuple[TunedFilter, ...]:
    """Search the best filter of each kind, for each number of samples and each set of
    lights.
    """
    results = []
    for count, light_set in product(counts, scene.sets):
        errors = error_statistics(samples.point_samples(count), light_set)
        results.append(TunedFilter(NONE, count, light_set.name, None, errors))
    tasks = list(product(kinds, counts))
    for done, (kind, count) in enumerate(tasks, 1):
        tried = candidates(kind, stride)
        encoders = [filters.resampling_matrix(low_pass, count).T for low_pass in tried]
        for light_set in scene.sets:
            best = tried[_mean_errors(light_set, count, encoders).argmin()]
            filtered = filters.filtered_point_samples(count, best)
            errors = error_statistics(filtered, light_set)
            results.append(TunedFilter(kind, count, light_set.name, best, errors))
        progress(Progress("filters", done, len(tasks)))
    return tuple(results)


def _mean_errors(light_set: LightSet, count: int, encoders: Iterable[Array]) -> Array:
    """Mean ΔE00 of encoders (81, count) of the 5 nm table, faster than
    `error_statistics`.
    """
    surfaces = light_set.reflectances[:, :: samples.TABLE_STRIDE]
    lights = light_set.powers[:, :: samples.TABLE_STRIDE]
    to_xyz = samples.point_samples(count).xyz
    errors = []
    for encoder in encoders:
        products = (lights @ encoder)[:, None] * (surfaces @ encoder)
        lab = light_set.to_lab(to_xyz(products))
        errors.append(delta_e_2000(lab, light_set.lab).mean())
    return np.array(errors)


def filter_records(tuned: Iterable[TunedFilter]) -> list[dict[str, Any]]:
    """Convert tuned filters to records."""
    return [
        {
            "lights": best.lights,
            "samples": best.count,
            "filter": best.kind,
            "parameters": best.parameters,
            **best.statistics._asdict(),
        }
        for best in tuned
    ]
