"""Failures of the fit: builds over lattice sizes, models, RGB spaces, thresholds and
atlases.

A grid varies one axis against the model variants, with the other axes at values for
which it has an effect. A Latin hypercube sample of all combinations covers the rest.
Synthetic atlases are difficult to fit.
"""

import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from uplift.atlas import LOWEST, Atlas, Entry
from uplift.colorimetry import observer, solid
from uplift.common.arrays import Array
from uplift.common.errors import UpliftWarning, unknown_name
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.lattice import Status
from uplift.models import Sigmoid
from uplift.pipeline.build import build
from uplift.pipeline.options import ModelName

ENTRIES = 24
"""Number of entries of the spiky and of the noisy atlas."""
HIGHEST = 1.05
"""Largest reflectance of the noisy atlas."""


def crowded() -> Atlas:
    """Make 120 smooth spectra of one paint, whose colours differ by about 1 ΔE."""
    rng = np.random.default_rng(1)
    paint = 0.3 + 0.15 * np.tanh((observer.grid() - 580) / 60)
    spectra = [paint + _smooth_deviation(rng, 0.01) for _ in range(120)]
    return _atlas("crowded", spectra)


def spiky() -> Atlas:
    """Make spectra of two peaks or dips of 8 nm, which few moments cannot represent."""
    rng = np.random.default_rng(2)
    spectra = []
    for number in range(ENTRIES):
        offset = observer.grid()[:, None] - rng.uniform(430, 670, 2)
        peaks = np.exp(-((offset / 8) ** 2)).max(axis=1)
        spectra.append(0.95 - 0.93 * peaks if number % 2 else 0.02 + 0.93 * peaks)
    return _atlas("spiky", spectra)


def noisy() -> Atlas:
    """Make smooth spectra with noise, as of a poor instrument in a dark room, that
    leaves [0, 1].
    """
    rng = np.random.default_rng(3)
    spectra = []
    for level in np.linspace(0.05, 0.95, ENTRIES):
        noise = rng.normal(0, 0.05, len(observer.grid()))
        reflectance = level + _smooth_deviation(rng, 0.1) + noise
        spectra.append(np.clip(reflectance, LOWEST, HIGHEST))
    return _atlas("noisy", spectra)


SYNTHETIC_ATLASES: dict[str, Callable[[], Atlas]] = {
    "crowded": crowded,
    "spiky": spiky,
    "noisy": noisy,
}


def _smooth_deviation(rng: np.random.Generator, amplitude: float) -> Array:
    """Random sum (N,) of the first four cosines over the range."""
    phase = np.linspace(0, np.pi, len(observer.grid()))
    return np.cos(phase[:, None] * np.arange(1, 5)) @ rng.normal(0, amplitude, 4)


def _atlas(name: str, spectra: list[Array]) -> Atlas:
    entries = [
        Entry(f"{name} {number}", observer.grid(), row)
        for number, row in enumerate(spectra, 1)
    ]
    return Atlas(tuple(entries))


NO_ATLAS = "none"
Record = dict[str, Any]


@dataclass(frozen=True, order=True)
class RunConfig:
    """Options of one build; ``atlas`` is the name of an atlas, or `NO_ATLAS`."""

    model: ModelName = "moments"
    coefficients: int = 9
    dim: int = 17
    space: str = "sRGB"
    threshold: float = 1e-4
    atlas: str = NO_ATLAS

    @property
    def model_label(self) -> str:
        """Model with its number of coefficients, such as ``moments 9``."""
        if self.model == Sigmoid.name:
            return self.model
        return f"{self.model} {self.coefficients}"


def study_stability(
    configs: Iterable[RunConfig],
    atlases: Mapping[str, Atlas],
    progress: ProgressCallback = ignore_progress,
) -> dict[RunConfig, Record]:
    """Run every configuration once, ordered by model so that compiled functions are
    reused.
    """
    ordered = sorted(set(configs))
    for config in ordered:
        if config.atlas not in (NO_ATLAS, *atlases):
            raise unknown_name(config.atlas, (NO_ATLAS, *atlases), "atlas")
    results = {}
    for number, config in enumerate(ordered, 1):
        results[config] = run(config, atlases)
        progress(Progress("builds", number, len(ordered)))
    return results


def run(config: RunConfig, atlases: Mapping[str, Atlas]) -> Record:
    """Build one configuration, count the realisable nodes that failed, and find the
    worst.

    The record has the options; the share ``success`` of the realisable nodes that are
    fitted; ``points``, all nodes; ``realisable``, those whose colour some reflectance
    has; ``unfitted``, realisable nodes farther from their colour than the threshold;
    ``stand_ins``, unrealisable ones farther from the realisable colour that they are
    fitted to; ``rounds`` of growth after the first; ``calls``, nodes that improvement
    was tried on, summed over its steps; ``worst``, the largest distance of a realisable
    node, max |linear RGB|, and its colour ``r``, ``g``, ``b``; ``seconds`` of wall
    time, including compilation.
    """
    steps = [0]
    options = asdict(config)
    atlas = atlases.get(options.pop("atlas"))
    start = time.perf_counter()
    with warnings.catch_warnings(action="ignore", category=UpliftWarning):
        data = build(
            atlas, progress=lambda progress: steps.append(progress.step), **options
        ).data
    seconds = time.perf_counter() - start
    realisable = solid(data.sensor.matrix).contains(data.lattice.points)
    distance = np.where(realisable, data.points.distance, -1)
    worst = int(distance.argmax())
    count = int(realisable.sum())
    unfitted = int((distance > config.threshold).sum())
    return {
        **asdict(config),
        "success": 1 - unfitted / count,
        "points": len(data.lattice.points),
        "realisable": count,
        "unfitted": unfitted,
        "stand_ins": int((~realisable & (data.points.status == Status.UNFITTED)).sum()),
        "rounds": max(steps),
        "calls": sum(step["tried"] for step in data.provenance["improvements"]),
        "worst": float(distance[worst]),
        **dict(zip("rgb", data.lattice.points[worst].tolist(), strict=True)),
        "seconds": seconds,
    }


SPACES = ("sRGB", "P3-D65", "ITU-R BT.2020", "ACEScg", "ProPhoto RGB")
SMALL_DIM = 9
"""Size of slow builds: thresholds near the rounding of stored numbers, in wide-gamut
spaces.
"""
MAX_SAMPLED_DIM = 17
"""Largest size in the sample."""
SEED = 4


@dataclass(frozen=True)
class DesignSpace:
    """Values of each axis of the design, and the size of the Latin hypercube sample.

    Grids vary one axis at the other values of `RunConfig`, in a lattice of the size
    that is nearest to its own.
    """

    dims: tuple[int, ...] = (4, 8, 17, 32, 64)
    coefficients: tuple[int, ...] = (3, 5, 9, 17)
    spaces: tuple[str, ...] = SPACES
    thresholds: tuple[float, ...] = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
    atlases: tuple[str, ...] = (NO_ATLAS, *SYNTHETIC_ATLASES)
    samples: int = 12

    @property
    def variants(self) -> tuple[RunConfig, ...]:
        """A configuration for every model and number of coefficients."""
        return (
            *(RunConfig("moments", count) for count in self.coefficients),
            RunConfig("sigmoid", Sigmoid.count),
        )

    def grids(self) -> Iterator[RunConfig]:
        """Yield every variant at the values of one axis, the others fixed."""
        usual = min(self.dims, key=lambda dim: abs(dim - RunConfig.dim))
        small = min(self.dims, key=lambda dim: abs(dim - SMALL_DIM))
        grids: tuple[tuple[str, tuple[Any, ...], dict[str, Any]], ...] = (
            ("space", self.spaces, {"dim": usual}),
            ("threshold", self.thresholds, {"dim": usual}),
            ("threshold", self.thresholds, {"dim": small, "space": self.spaces[-1]}),
            ("atlas", self.atlases, {"dim": usual}),
            ("dim", self.dims, {}),
        )
        for axis, values, fixed in grids:
            for variant, value in product(self.variants, values):
                yield replace(variant, **fixed | {axis: value})

    def sample(self) -> tuple[RunConfig, ...]:
        """Draw configurations up to `MAX_SAMPLED_DIM` from a Latin hypercube with a
        fixed seed.
        """
        from scipy.stats import qmc

        dims = [dim for dim in self.dims if dim <= MAX_SAMPLED_DIM]
        axes = (self.variants, dims, self.spaces, self.thresholds, self.atlases)
        hypercube = qmc.LatinHypercube(len(axes), rng=np.random.default_rng(SEED))
        rows = hypercube.random(self.samples) * [len(axis) for axis in axes]
        drawn = []
        for variant, dim, space, threshold, atlas in rows.astype(int):
            drawn.append(
                replace(
                    self.variants[variant],
                    dim=dims[dim],
                    space=self.spaces[space],
                    threshold=self.thresholds[threshold],
                    atlas=self.atlases[atlas],
                )
            )
        return tuple(drawn)

    def configs(self) -> tuple[RunConfig, ...]:
        """List every configuration of the grids and of the sample once."""
        return tuple(dict.fromkeys([*self.grids(), *self.sample()]))


QUICK_DESIGN = DesignSpace(
    dims=(4, 9),
    coefficients=(3, 9),
    spaces=(SPACES[0], SPACES[-1]),
    thresholds=(1e-3, 1e-4, 1e-5),
    samples=4,
)
