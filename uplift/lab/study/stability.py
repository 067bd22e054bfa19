"""Failures of the fit: builds over lattice sizes, models, RGB spaces, thresholds and atlases.

A grid varies one axis against the model variants, with the other axes at values for which it has an effect. A Latin
hypercube sample of all combinations covers the rest. Synthetic atlases are difficult to fit."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from math import prod
from typing import Any

import numpy as np

from uplift.atlas import Atlas, Entry
from uplift.atlas.atlas import LOWEST
from uplift.colorimetry import observer
from uplift.colorimetry.solid import solid
from uplift.common.arrays import Array
from uplift.common.errors import OptionError, UpliftWarning, unknown_name
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.lattice import Status
from uplift.models import Moments, Sigmoid
from uplift.pipeline.build import build
from uplift.pipeline.options import MODELS, ModelName

CROWDED_ENTRIES, ENTRIES = 120, 24
"""Numbers of entries of the crowded atlas and of the others."""
ATLAS_NOISE = 0.05
"""Standard deviation of the reflectances of the noisy atlas, as of a poor instrument in a dark room."""
PEAK_HALF_WIDTH = 8.0
"""Half-width in nm of the peaks of the spiky atlas."""
HIGHEST = 1.05
"""Largest reflectance of the noisy atlas."""


def crowded() -> Atlas:
    """Make 120 smooth spectra of one paint, whose colours differ by about 1 ΔE."""
    rng = np.random.default_rng(1)
    slope = np.tanh((observer.grid() - 580) / 60)
    spectra = [0.3 + 0.15 * slope + _smooth_deviation(rng, 0.01) for _ in range(CROWDED_ENTRIES)]
    return _atlas("crowded", spectra)


def spiky() -> Atlas:
    """Make spectra of two narrow peaks on black, or two narrow dips on white, which few moments cannot represent."""
    rng, wavelengths = np.random.default_rng(2), observer.grid()

    def spectrum(dark: bool) -> Array:
        centres = rng.uniform(430, 670, 2)
        peaks = np.exp(-(((wavelengths[:, None] - centres) / PEAK_HALF_WIDTH) ** 2)).max(axis=1)
        return np.asarray(0.02 + 0.93 * peaks if dark else 0.95 - 0.93 * peaks)

    return _atlas("spiky", [spectrum(number % 2 == 0) for number in range(ENTRIES)])


def noisy() -> Atlas:
    """Make smooth spectra with noise that leaves [0, 1] as far as readers allow."""
    rng = np.random.default_rng(3)

    def spectrum(level: float) -> Array:
        noise = rng.normal(0, ATLAS_NOISE, len(observer.grid()))
        return np.clip(level + _smooth_deviation(rng, 0.1) + noise, LOWEST, HIGHEST)

    return _atlas("noisy", [spectrum(level) for level in np.linspace(0.05, 0.95, ENTRIES)])


SYNTHETIC_ATLASES: dict[str, Callable[[], Atlas]] = {"crowded": crowded, "spiky": spiky, "noisy": noisy}
"""Functions that make the atlases, by name."""


def _smooth_deviation(rng: np.random.Generator, amplitude: float) -> Array:
    """Random sum (N,) of the first four cosines over the range."""
    phase = np.linspace(0, np.pi, len(observer.grid()))
    cosines = np.cos(phase[:, None] * np.arange(1, 5))
    return np.asarray(cosines @ rng.normal(0, amplitude, 4))


def _atlas(name: str, spectra: list[Array]) -> Atlas:
    entries = (Entry(f"{name} {number}", observer.grid(), row) for number, row in enumerate(spectra, 1))
    return Atlas(tuple(entries))


NO_ATLAS = "none"


@dataclass(frozen=True, order=True)
class RunConfig:
    """Options of one build.

    ``model``: name of the spectrum model.
    ``coefficients``: coefficients per spectrum.
    ``dim``: lattice points along each axis.
    ``space``: RGB space.
    ``threshold``: largest distance of a fitted point.
    ``atlas``: name of an atlas, or `NO_ATLAS`.
    """

    model: ModelName = "moments"
    coefficients: int = 9
    dim: int = 17
    space: str = "sRGB"
    threshold: float = 1e-4
    atlas: str = NO_ATLAS

    @property
    def model_label(self) -> str:
        """Model with its number of coefficients, such as ``moments 9``."""
        return self.model if self.model == Sigmoid.name else f"{self.model} {self.coefficients}"


@dataclass(frozen=True)
class RunResult:
    """Result of one build.

    ``config``: options of the build.
    ``points``, ``realisable``: lattice points, and those whose colour some reflectance has.
    ``unfitted``: realisable points farther from their colour than the threshold.
    ``stand_ins``: unrealisable points farther from their nearest realisable colour than the threshold.
    ``rounds``: rounds of growth after the first.
    ``calls``: points that improvement was tried on, summed over its steps.
    ``worst``: largest distance of a realisable point, max |linear RGB|.
    ``r``, ``g``, ``b``: colour of that point.
    ``seconds``: wall time, including compilation.
    """

    config: RunConfig
    points: int
    realisable: int
    unfitted: int
    stand_ins: int
    rounds: int
    calls: int
    worst: float
    r: float
    g: float
    b: float
    seconds: float = field(compare=False)

    @property
    def success(self) -> float:
        """Share of the realisable points that are fitted."""
        return 1 - self.unfitted / self.realisable

    def record(self) -> dict[str, Any]:
        """Convert to a flat record for JSON and CSV."""
        rest = asdict(self)
        return rest.pop("config") | {"success": self.success} | rest


def study_stability(
    configs: Iterable[RunConfig],
    atlases: Mapping[str, Atlas],
    progress: ProgressCallback = ignore_progress,
) -> list[RunResult]:
    """Run every configuration once, ordered by model so that compiled functions are reused.

    Raises `UnknownNameError`, `UpliftError`.
    """
    ordered = sorted(set(configs))
    for config in ordered:
        if config.atlas not in (NO_ATLAS, *atlases):
            raise unknown_name(config.atlas, (NO_ATLAS, *atlases), "atlas")
    results = []
    for number, config in enumerate(ordered, 1):
        results.append(run(config, atlases))
        progress(Progress("builds", number, len(ordered)))
    return results


def run(config: RunConfig, atlases: Mapping[str, Atlas]) -> RunResult:
    """Build one configuration, count the realisable points that failed, and find the worst. Raises `UpliftError`."""
    rounds = 0

    def count_rounds(progress: Progress) -> None:
        nonlocal rounds
        rounds = max(rounds, progress.step)

    start = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        data = build(
            atlases[config.atlas] if config.atlas != NO_ATLAS else None,
            progress=count_rounds,
            dim=config.dim,
            model=config.model,
            coefficients=config.coefficients,
            space=config.space,
            threshold=config.threshold,
        ).data
    seconds = time.perf_counter() - start
    realisable = solid(data.sensor.matrix).contains(data.lattice.points)
    of_realisable = np.where(realisable, data.points.distance, -1)
    worst = int(of_realisable.argmax())
    r, g, b = data.lattice.points[worst].tolist()
    return RunResult(
        config,
        points=len(data.lattice.points),
        realisable=int(realisable.sum()),
        unfitted=int((of_realisable > config.threshold).sum()),
        stand_ins=int((~realisable & (data.points.status == Status.UNFITTED)).sum()),
        rounds=rounds,
        calls=sum(step["tried"] for step in data.provenance["improvements"]),
        worst=float(of_realisable[worst]),
        r=r,
        g=g,
        b=b,
        seconds=seconds,
    )


SPACES = ("sRGB", "P3-D65", "ITU-R BT.2020", "ACEScg", "ProPhoto RGB")
DEFAULT_DIM, DEFAULT_THRESHOLD = 17, 1e-4
SMALL_DIM = 9
"""Size of slow builds: thresholds near the rounding of stored numbers, in wide-gamut spaces."""
MAX_SAMPLED_DIM = 17
"""Largest size in the sample."""
SEED = 4


@dataclass(frozen=True)
class DesignSpace:
    """Values of each axis of the design.

    ``dims``, ``coefficients``, ``spaces``, ``models``, ``thresholds``, ``atlases``: values of the fields of
        `RunConfig`, not empty.
    ``samples``: size of the Latin hypercube sample.
    """

    dims: tuple[int, ...] = (4, 8, 17, 32, 64)
    coefficients: tuple[int, ...] = (3, 5, 9, 17)
    spaces: tuple[str, ...] = SPACES
    models: tuple[str, ...] = MODELS
    thresholds: tuple[float, ...] = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
    atlases: tuple[str, ...] = (NO_ATLAS, *SYNTHETIC_ATLASES)
    samples: int = 12

    def __post_init__(self) -> None:
        for name in ("dims", "coefficients", "spaces", "models", "thresholds", "atlases"):
            if not getattr(self, name):
                raise OptionError(f"{name} must not be empty", code="empty-axis", hint="give at least one value")

    @property
    def variants(self) -> tuple[RunConfig, ...]:
        """A configuration for every model and number of coefficients."""
        moments = [RunConfig("moments", count) for count in self.coefficients if Moments.name in self.models]
        return (*moments, *[RunConfig("sigmoid", Sigmoid.count)] * (Sigmoid.name in self.models))

    def nearest_dim(self, dim: int) -> int:
        """Nearest value of ``dims``."""
        return min(self.dims, key=lambda value: abs(value - dim))

    def fixed(self, **preferred: Any) -> dict[str, Any]:
        """Values of the axes that a grid does not vary: the preferred or default value if present, else the first."""
        return {
            "dim": self.nearest_dim(preferred.get("dim", DEFAULT_DIM)),
            "space": _preferred(self.spaces, preferred.get("space", SPACES[0])),
            "threshold": _preferred(self.thresholds, preferred.get("threshold", DEFAULT_THRESHOLD)),
            "atlas": _preferred(self.atlases, NO_ATLAS),
        }


QUICK_DESIGN = DesignSpace(
    dims=(4, 9),
    coefficients=(3, 9),
    spaces=(SPACES[0], SPACES[-1]),
    thresholds=(1e-3, 1e-4, 1e-5),
    samples=4,
)


@dataclass(frozen=True)
class Grid:
    """One axis against the model variants.

    ``title``: title of the figure.
    ``axis``: field of `RunConfig` that varies.
    ``values``: values of the axis.
    ``variants``: models and numbers of coefficients.
    ``fixed``: values of the other fields.
    """

    title: str
    axis: str
    values: tuple[Any, ...]
    variants: tuple[RunConfig, ...]
    fixed: dict[str, Any]

    def rows(self) -> Iterator[tuple[str, list[RunConfig]]]:
        """Yield the label of every variant, and its configurations along the axis."""
        for variant in self.variants:
            configs = [replace(variant, **self.fixed | {self.axis: value}) for value in self.values]
            yield variant.model_label, configs


def grids(space: DesignSpace) -> tuple[Grid, ...]:
    """Make the grids of a design, without repetition."""
    default = space.fixed()
    wide_and_small = space.fixed(space=SPACES[-1], dim=SMALL_DIM)
    axes = [
        ("space", space.spaces, default),
        ("threshold", space.thresholds, default),
        ("threshold", space.thresholds, wide_and_small),
        ("atlas", space.atlases, default),
        ("dim", space.dims, default),
    ]
    by_title = {}
    for axis, values, fixed in axes:
        rest = ", ".join(_describe(name, value) for name, value in fixed.items() if name != axis)
        title = f"by {axis}: {rest}"
        by_title[title] = Grid(title, axis, values, space.variants, fixed)
    return tuple(by_title.values())


def draw_sample(space: DesignSpace) -> tuple[RunConfig, ...]:
    """Draw distinct configurations up to `MAX_SAMPLED_DIM` from Latin hypercubes with a fixed seed."""
    from scipy.stats import qmc

    dims = [dim for dim in space.dims if dim <= MAX_SAMPLED_DIM] or [min(space.dims)]
    axes = (space.variants, dims, space.spaces, space.thresholds, space.atlases)
    sizes = [len(values) for values in axes]
    count = min(space.samples, prod(sizes))
    hypercube = qmc.LatinHypercube(len(sizes), rng=np.random.default_rng(SEED))
    drawn: dict[RunConfig, None] = {}
    while len(drawn) < count:  # several points of one hypercube may be the same combination
        for row in hypercube.integers(np.zeros(len(sizes), int), u_bounds=sizes, n=count).tolist():
            variant, dim, rgb_space, threshold, atlas = (axis[i] for axis, i in zip(axes, row, strict=True))
            drawn[replace(variant, dim=dim, space=rgb_space, threshold=threshold, atlas=atlas)] = None
    return tuple(drawn)[:count]


def design(space: DesignSpace) -> tuple[RunConfig, ...]:
    """List every configuration of the grids and of the sample once."""
    in_grids = [config for grid in grids(space) for _, row in grid.rows() for config in row]
    return tuple(dict.fromkeys([*in_grids, *draw_sample(space)]))


def _preferred(values: tuple[Any, ...], preferred: Any) -> Any:
    return preferred if preferred in values else values[0]


def _describe(name: str, value: Any) -> str:
    if name == "atlas":
        return "no atlas" if value == NO_ATLAS else f"atlas {value}"
    return {"dim": f"{value}³", "threshold": f"threshold {value}"}.get(name, f"{value}")
