"""Failures of the fit: builds over lattice sizes, models, RGB spaces, thresholds and
atlases.

A grid varies one axis against the model variants, with the other axes at values for
which it has an effect. A Latin hypercube sample of all combinations covers the rest.
Synthetic atlases are difficult to fit.
"""

import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import product
from operator import getitem
from typing import Any

import numpy as np

from uplift.atlas.atlas import LOWEST, Atlas, Entry
from uplift.colorimetry import observer
from uplift.colorimetry.object_colours import solid
from uplift.common.errors import UpliftWarning, unknown_name
from uplift.common.progress import ProgressCallback, ignore_progress, reported
from uplift.extras.timing import stopwatch
from uplift.lab.runner import Row
from uplift.lattice.point_table import Status
from uplift.models.sigmoid import Sigmoid
from uplift.pipeline.build import build
from uplift.pipeline.options import ModelName

NO_ATLAS = "none"
CROWD = 120
"""Number of entries of the crowded atlas."""
ENTRIES = 24
"""Number of entries of the spiky and of the noisy atlas."""
HIGHEST = 1.05
"""Largest reflectance of the noisy atlas."""


def synthetic_atlases() -> dict[str, Atlas]:
    """Make atlases that are difficult to fit.

    *crowded*: smooth spectra of one paint, whose colours differ by about 1 ΔE. *spiky*:
    two peaks or dips of 8 nm, which few moments cannot represent. *noisy*: smooth
    spectra with noise, as of a poor instrument in a dark room, that leaves [0, 1].
    """
    nm = observer.grid()
    cosines = np.cos(np.outer(np.arange(1, 5), np.linspace(0, np.pi, len(nm))))
    paint = 0.3 + 0.15 * np.tanh((nm - 580) / 60)
    deviations = np.random.default_rng(1).normal(0, 0.01, (CROWD, 4))
    centres = np.random.default_rng(2).uniform(430, 670, (ENTRIES, 2))
    peaks = 0.93 * np.exp(-(((nm - centres[..., None]) / 8) ** 2)).max(axis=1)
    is_dip = np.arange(ENTRIES)[:, None] % 2 == 1
    levels = np.linspace(0.05, 0.95, ENTRIES)[:, None]
    draws = np.random.default_rng(3).normal(size=(ENTRIES, len(nm) + 4))
    noise = 0.05 * draws[:, :-4] + 0.1 * draws[:, -4:] @ cosines
    spectra = {
        "crowded": paint + deviations @ cosines,
        "spiky": np.where(is_dip, 0.95 - peaks, 0.02 + peaks),
        "noisy": np.clip(levels + noise, LOWEST, HIGHEST),
    }
    atlases = {}
    for name, rows in spectra.items():
        entries = (Entry(f"{name} {row}", nm, rows[row]) for row in range(len(rows)))
        atlases[name] = Atlas(tuple(entries))
    return atlases


@dataclass(frozen=True, order=True)
class RunConfig:
    """Options of one build; ``atlas`` is the name of an atlas, or `NO_ATLAS`."""

    model: ModelName = "moments"
    coefficients: int = 9
    dim: int = 17
    space: str = "sRGB"
    threshold: float = 1e-4
    atlas: str = NO_ATLAS


def study_stability(
    configs: Iterable[RunConfig],
    atlases: Mapping[str, Atlas],
    progress: ProgressCallback = ignore_progress,
) -> list[Row]:
    """Run every configuration once, ordered by model so that compiled functions are
    reused.
    """
    ordered = sorted(set(configs))
    for config in ordered:
        if config.atlas not in (NO_ATLAS, *atlases):
            raise unknown_name(config.atlas, (NO_ATLAS, *atlases), "atlas")
    return [
        evaluate(config, atlases) for config in reported(ordered, "builds", progress)
    ]


def evaluate(config: RunConfig, atlases: Mapping[str, Atlas]) -> Row:
    """Build one configuration, count the realisable nodes that failed, and find the
    worst.

    The row has the options; the share ``success`` of the realisable nodes that are
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
    options["progress"] = lambda progress: steps.append(progress.step)
    with warnings.catch_warnings(action="ignore", category=UpliftWarning):
        cube, run = stopwatch(lambda: build(atlas, **options))
    data = cube.data
    nodes = data.lattice.points
    realisable = solid(data.sensor.matrix).contains(nodes)
    distance = np.where(realisable, data.points.distance, -1)
    worst = int(distance.argmax())
    count = int(realisable.sum())
    unfitted = int((distance > config.threshold).sum())
    return {
        **asdict(config),
        "success": 1 - unfitted / count,
        "points": len(nodes),
        "realisable": count,
        "unfitted": unfitted,
        "stand_ins": int((~realisable & (data.points.status == Status.UNFITTED)).sum()),
        "rounds": max(steps),
        "calls": sum(step["tried"] for step in data.provenance["improvements"]),
        "worst": float(distance[worst]),
        **dict(zip("rgb", nodes[worst].tolist(), strict=True)),
        "seconds": run.wall,
    }


MAX_SAMPLED_DIM = 17
"""Largest size in the sample."""
SEED = 4


@dataclass(frozen=True)
class DesignSpace:
    """Numbers of coefficients, values of ``axes``, which are other options of builds,
    and the size of the Latin hypercube sample.

    Grids vary one axis at the other values of `RunConfig` in lattices of ``usual_dim``.
    Thresholds near the rounding of stored numbers are slow in wide-gamut spaces, and
    vary there in lattices of ``small_dim``.
    """

    coefficients: tuple[int, ...]
    axes: dict[str, Sequence[Any]]
    samples: int
    usual_dim: int
    small_dim: int

    def with_atlases(self, names: Iterable[str]) -> "DesignSpace":
        """Add an axis of atlases, and none."""
        return replace(self, axes=self.axes | {"atlas": (NO_ATLAS, *names)})

    @property
    def variants(self) -> list[RunConfig]:
        """A configuration for every model and number of coefficients."""
        moments = [RunConfig("moments", count) for count in self.coefficients]
        return [*moments, RunConfig("sigmoid", Sigmoid.count)]

    def grids(self) -> Iterator[RunConfig]:
        """Yield every variant at the values of one axis, the others fixed, and at all
        thresholds in the last space.
        """
        for axis, values in self.axes.items():
            for variant, value in product(self.variants, values):
                yield replace(variant, **{"dim": self.usual_dim, axis: value})
        slow = {"dim": self.small_dim, "space": self.axes["space"][-1]}
        for variant, threshold in product(self.variants, self.axes["threshold"]):
            yield replace(variant, **slow, threshold=threshold)

    def sample(self) -> Iterator[RunConfig]:
        """Draw configurations up to `MAX_SAMPLED_DIM` from a Latin hypercube with a
        fixed seed.
        """
        from scipy.stats import qmc

        dims = [dim for dim in self.axes["dim"] if dim <= MAX_SAMPLED_DIM]
        axes = self.axes | {"dim": dims}
        lengths = [len(self.variants), *map(len, axes.values())]
        hypercube = qmc.LatinHypercube(len(lengths), rng=np.random.default_rng(SEED))
        for variant, *row in hypercube.integers(lengths, n=self.samples):
            drawn = dict(zip(axes, map(getitem, axes.values(), row), strict=True))
            yield replace(self.variants[variant], **drawn)

    def configs(self) -> list[RunConfig]:
        """List every configuration of the grids and of the sample once."""
        return list(dict.fromkeys([*self.grids(), *self.sample()]))


DESIGN = DesignSpace(
    coefficients=(3, 5, 9, 17),
    axes={
        "dim": (4, 8, 17, 32, 64),
        "space": ("sRGB", "P3-D65", "ITU-R BT.2020", "ACEScg", "ProPhoto RGB"),
        "threshold": (1e-2, 1e-3, 1e-4, 1e-5, 1e-6),
    },
    samples=12,
    usual_dim=17,
    small_dim=8,
)
QUICK_DESIGN = DesignSpace(
    coefficients=(3, 9),
    axes={
        "dim": (4, 9),
        "space": ("sRGB", "ProPhoto RGB"),
        "threshold": (1e-3, 1e-4, 1e-5),
    },
    samples=4,
    usual_dim=9,
    small_dim=9,
)
