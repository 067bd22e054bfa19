"""Low-pass filters before point sampling: a grid search for the parameters that leave least error.

Kment 2011, 6.3 and tables A.1 and A.2. Lights and surfaces alike go through the filter.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000
from uplift.common.arrays import Array
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.lab.comparison.measure import error_statistics
from uplift.lab.comparison.scene import LightSet, Scene
from uplift.lab.comparison.statistics import Statistics
from uplift.scene.representations.dense import TABLE_STRIDE
from uplift.scene.representations.filtered_point_sampling import filtered_point_samples
from uplift.scene.representations.filters import FINE_STRIDE, KINDS, Filter, candidates, resampling_matrix
from uplift.scene.representations.point_sampling import point_samples

COUNTS = (4, 8, 16)
"""As the thesis has them."""
NONE = "none"


@dataclass(frozen=True)
class Tuned:
    """The best filter of a kind for so many samples under a set of lights; ``low_pass`` None for no filter."""

    kind: str
    count: int
    lights: str
    low_pass: Filter | None
    statistics: Statistics

    @property
    def told(self) -> str:
        """The filter's parameters, to be read."""
        if self.low_pass is None:
            return ""
        named = zip(KINDS[self.kind].choices, self.low_pass.parameters, strict=True)
        return ", ".join([f"extent {self.low_pass.extent}", *(f"{key} {value:g}" for key, value in named)])


def tune(
    scene: Scene,
    every: int = FINE_STRIDE,
    kinds: Sequence[str] = tuple(KINDS),
    counts: Sequence[int] = COUNTS,
    progress: ProgressCallback = ignore_progress,
) -> tuple[Tuned, ...]:
    """Without a filter, then the best of each kind, for each count of samples and each set of lights.

    The search tries ``every`` so many of the choices for each parameter.
    """
    found = [
        Tuned(NONE, count, part.name, None, error_statistics(point_samples(count), scene, part))
        for count in counts
        for part in scene.sets
    ]
    tasks = list(product(kinds, counts))
    for done, (kind, count) in enumerate(tasks, 1):
        for part, low_pass in zip(scene.sets, _best(candidates(kind, every), count, scene), strict=True):
            best = error_statistics(filtered_point_samples(count, low_pass), scene, part)
            found.append(Tuned(kind, count, part.name, low_pass, best))
        progress(Progress("filters", done, len(tasks)))
    return tuple(found)


def _best(tried: Sequence[Filter], count: int, scene: Scene) -> list[Filter]:
    """Under each set of lights that of the least mean error."""
    judges = [_judge(scene, part, count) for part in scene.sets]
    means = np.empty((len(tried), len(judges)))
    for row, low_pass in enumerate(tried):
        encoder = resampling_matrix(low_pass, count).T
        means[row] = [error_statistics(encoder) for error_statistics in judges]
    return [tried[int(row)] for row in means.argmin(axis=0)]


def _judge(scene: Scene, part: LightSet, count: int) -> Callable[[Array], float]:
    """From what takes the 5 nm table to samples, (81, count), to the mean ΔE00: `error_statistics`, quicker."""
    surfaces, lights = scene.surfaces[:, ::TABLE_STRIDE], part.powers[:, ::TABLE_STRIDE]
    reference, weights = scene.reference(part), point_samples(count).weights

    def mean(encoder: Array) -> float:
        sent = (lights @ encoder)[:, None] * (surfaces @ encoder)
        return float(delta_e_2000(part.lab(sent @ weights), reference).mean())

    return mean
