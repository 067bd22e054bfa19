"""Where the fit fails: one build after another over dims, models, spaces, thresholds and atlases, each judged."""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from uplift.atlas import Atlas
from uplift.colorimetry import observer
from uplift.colorimetry.solid import solid
from uplift.common.arrays import Array
from uplift.common.errors import UpliftWarning, unknown_name
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.lab.study.pointwise import IN_MOMENTS, IN_MULTIPLIERS, PointwiseProblem, fit_pointwise
from uplift.lattice import Lattice, Status
from uplift.models import Moments, Sigmoid
from uplift.pipeline import build
from uplift.pipeline.options import ModelName

UPLIFT = "uplift"
SOLVERS = (UPLIFT, IN_MOMENTS, IN_MULTIPLIERS)
NO_ATLAS = "none"


@dataclass(frozen=True, order=True)
class RunConfig:
    """One build. ``solver`` is `UPLIFT`, or what the thesis's least squares solve in."""

    model: ModelName = "moments"
    coefficients: int = 9
    dim: int = 17
    space: str = "sRGB"
    threshold: float = 1e-4
    atlas: str = NO_ATLAS
    solver: str = UPLIFT

    @property
    def technique(self) -> str:
        """'sigmoid', or 'moments 9' by its coefficients."""
        return self.model if self.model == Sigmoid.name else f"{self.model} {self.coefficients}"


@dataclass(frozen=True)
class RunResult:
    """What became of a build.

    Parameters
    ----------
    points, realisable : lattice points, and those of a colour that some reflectance has.
    unfitted : realisable points further from their colour than the threshold.
    stand_ins : unrealisable points whose nearest realisable colour was missed by more than the threshold.
    rounds : of growth, after the first.
    calls : points that improvement steps were tried on, step by step; of scipy, starts beyond the first of a point.
    worst : the largest distance of a realisable point, max |linear RGB|; ``r``, ``g``, ``b`` its colour.
    seconds : wall time; with what is compiled for the first time.
    """

    setting: RunConfig
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
        """Flat, for JSON and CSV."""
        rest = asdict(self)
        return rest.pop("setting") | {"success": self.success} | rest


def study_stability(
    settings: Iterable[RunConfig],
    atlases: Mapping[str, Atlas],
    progress: ProgressCallback = ignore_progress,
) -> list[RunResult]:
    """Run every setting; ``progress`` hears how many of how many are done.

    In the order of models, so that what JAX compiles for one is all used before the next.

    Raises
    ------
    UpliftError : an atlas that is not there, before any work; a setting that cannot be built.
    """
    ordered = sorted(set(settings))
    for setting in ordered:
        if setting.atlas not in (NO_ATLAS, *atlases):
            raise unknown_name(setting.atlas, (NO_ATLAS, *atlases), "atlas")
    outcomes = []
    for number, setting in enumerate(ordered, 1):
        outcomes.append(run(setting, atlases))
        progress(Progress("builds", number, len(ordered)))
    return outcomes


def run(setting: RunConfig, atlases: Mapping[str, Atlas]) -> RunResult:
    """Build, and judge by what is stored. Raises `UpliftError` for what cannot be built."""
    return _ours(setting, atlases) if setting.solver == UPLIFT else _pointwise(setting)


def _ours(setting: RunConfig, atlases: Mapping[str, Atlas]) -> RunResult:
    rounds = 0

    def progress(done: Progress) -> None:
        nonlocal rounds
        rounds = max(rounds, done.step)

    begin = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        data = build(
            atlases[setting.atlas] if setting.atlas != NO_ATLAS else None,
            progress=progress,
            dim=setting.dim,
            model=setting.model,
            coefficients=setting.coefficients,
            space=setting.space,
            threshold=setting.threshold,
        ).data
    seconds = time.perf_counter() - begin
    unrealisable = ~solid(data.sensor.matrix).contains(data.lattice.points)
    calls = sum(step["tried"] for step in data.provenance["improvements"])
    missed = int((unrealisable & (data.points.status == Status.UNFITTED)).sum())
    return _judge(
        setting, data.lattice.points, ~unrealisable, data.points.distance, missed, rounds, calls, seconds
    )


def _pointwise(setting: RunConfig) -> RunResult:
    sensor = observer.sensor(setting.space)
    lattice = Lattice(observer.axis_nodes("srgb", setting.dim))
    begin = time.perf_counter()
    task = PointwiseProblem(Moments(setting.coefficients), sensor, setting.solver)
    grown = fit_pointwise(task, lattice, setting.threshold)
    seconds = time.perf_counter() - begin
    realisable = solid(sensor.matrix).contains(lattice.points)
    calls = grown.starts - lattice.size
    return _judge(setting, lattice.points, realisable, grown.distance, 0, grown.rounds, calls, seconds)


def _judge(
    setting: RunConfig,
    points: Array,
    realisable: Any,
    distance: Any,
    stand_ins: int,
    rounds: int,
    calls: int,
    seconds: float,
) -> RunResult:
    off = np.where(realisable, distance, -1)
    worst = int(off.argmax())
    r, g, b = (float(value) for value in points[worst])
    return RunResult(
        setting,
        points=len(points),
        realisable=int(realisable.sum()),
        unfitted=int((off > setting.threshold).sum()),
        stand_ins=stand_ins,
        rounds=rounds,
        calls=calls,
        worst=float(off[worst]),
        r=r,
        g=g,
        b=b,
        seconds=seconds,
    )
