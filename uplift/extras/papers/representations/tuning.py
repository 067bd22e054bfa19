"""Low-pass filters before point sampling that leave the smallest errors, by a grid
search (Kment 2011, section 6.3, tables A.1 and A.2); lights and surfaces are filtered
alike.
"""

from collections.abc import Iterable, Sequence
from itertools import product

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000
from uplift.common.arrays import Array
from uplift.common.progress import ProgressCallback, ignore_progress, reported
from uplift.extras.papers.representations import filters, samples
from uplift.extras.papers.representations.compare import (
    LightSet,
    Row,
    Scene,
    error_statistics,
)
from uplift.extras.papers.representations.filters import Filter
from uplift.extras.papers.representations.samples import Representation

COUNTS = (4, 8, 16)
"""Numbers of samples after a filter in the thesis."""
NONE = "none"
FINE_STRIDE = 1
COARSE_STRIDE = 5
"""A search tries every first or every fifth choice of each parameter."""


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
) -> list[Row]:
    """Search the best filter of each kind, for each number of samples and each set of
    lights; rows without a filter have the kind ``none``.
    """
    rows = []
    for count, light_set in product(counts, scene.sets):
        rows.append(_row(light_set, count, NONE, "", samples.point_samples(count)))
    tasks = list(product(kinds, counts))
    for kind, count in reported(tasks, "filters", progress):
        tried = candidates(kind, stride)
        encoders = [filters.resampling_matrix(low_pass, count).T for low_pass in tried]
        for light_set in scene.sets:
            best = tried[_mean_errors(light_set, count, encoders).argmin()]
            filtered = filters.filtered_point_samples(count, best)
            rows.append(_row(light_set, count, kind, parameters(best), filtered))
    return rows


def _row(
    light_set: LightSet, count: int, kind: str, text: str, sampled: Representation
) -> Row:
    head = {"lights": light_set.name, "samples": count, "filter": kind}
    return {**head, "parameters": text, **error_statistics(sampled, light_set)}


def parameters(low_pass: Filter) -> str:
    """Return extent and parameters of a filter as text."""
    text = f"extent {low_pass.extent}"
    names = filters.KINDS[low_pass.kind].choices
    for name, value in zip(names, low_pass.parameters, strict=True):
        text += f", {name} {value:g}"
    return text


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
