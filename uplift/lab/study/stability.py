"""Failures of the fit: builds over lattice sizes, models, RGB spaces, thresholds and atlases."""

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
from uplift.common.arrays import Array, Mask, Values
from uplift.common.errors import UpliftWarning, unknown_name
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.lab.study.pointwise import PointwiseProblem, fit_pointwise
from uplift.lattice import Lattice, Status
from uplift.models import Moments, Sigmoid
from uplift.pipeline.build import build
from uplift.pipeline.options import ModelName

__all__ = ["RunConfig", "RunResult", "run", "study_stability"]

UPLIFT = "uplift"
"""Solver of this package; the others are the unknowns of a `PointwiseProblem`."""
NO_ATLAS = "none"


@dataclass(frozen=True, order=True)
class RunConfig:
    """Options of one build.

    Parameters
    ----------
    model : str
        Name of the spectrum model.
    coefficients : int
        Coefficients per spectrum.
    dim : int
        Lattice points along each axis.
    space : str
        RGB space.
    threshold : float
        Largest distance of a fitted point.
    atlas : str
        Name of an atlas, or `NO_ATLAS`.
    solver : str
        `UPLIFT`, `IN_MOMENTS` or `IN_MULTIPLIERS`.
    """

    model: ModelName = "moments"
    coefficients: int = 9
    dim: int = 17
    space: str = "sRGB"
    threshold: float = 1e-4
    atlas: str = NO_ATLAS
    solver: str = UPLIFT

    @property
    def model_label(self) -> str:
        """Model with its number of coefficients, such as ``moments 9``."""
        return self.model if self.model == Sigmoid.name else f"{self.model} {self.coefficients}"


@dataclass(frozen=True)
class RunResult:
    """Result of one build.

    Parameters
    ----------
    config : RunConfig
        Options of the build.
    points, realisable : int
        Lattice points, and those whose colour some reflectance has.
    unfitted : int
        Realisable points farther from their colour than the threshold.
    stand_ins : int
        Unrealisable points farther from their nearest realisable colour than the threshold.
    rounds : int
        Rounds of growth after the first.
    calls : int
        Points that improvement was tried on, summed over its steps. For scipy, solves beyond the first of each point.
    worst : float
        Largest distance of a realisable point, max |linear RGB|.
    r, g, b : float
        Colour of that point.
    seconds : float
        Wall time, including compilation.
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
        """Convert to a flat record for JSON and CSV.

        Returns
        -------
        dict
            The fields of the configuration, the share of success, and the other fields.
        """
        rest = asdict(self)
        return rest.pop("config") | {"success": self.success} | rest


def study_stability(
    configs: Iterable[RunConfig],
    atlases: Mapping[str, Atlas],
    progress: ProgressCallback = ignore_progress,
) -> list[RunResult]:
    """Run every configuration once, ordered by model so that compiled functions are reused.

    Parameters
    ----------
    configs : iterable of RunConfig
        The builds.
    atlases : mapping of str to Atlas
        Atlases by the names in ``configs``.
    progress : callable, optional
        Called with the stage ``"builds"``.

    Returns
    -------
    list of RunResult
        Results in the order of the runs.

    Raises
    ------
    UnknownNameError
        An atlas is missing. Raised before any build.
    UpliftError
        A configuration cannot be built.
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
    """Build one configuration and evaluate the stored points.

    Parameters
    ----------
    config : RunConfig
        The build.
    atlases : mapping of str to Atlas
        Atlases by name.

    Returns
    -------
    RunResult
        The result.

    Raises
    ------
    UpliftError
        The configuration cannot be built.
    """
    return _run_uplift(config, atlases) if config.solver == UPLIFT else _run_pointwise(config)


def _run_uplift(config: RunConfig, atlases: Mapping[str, Atlas]) -> RunResult:
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
    return _evaluate(
        config,
        data.lattice.points,
        realisable,
        data.points.distance,
        stand_ins=int((~realisable & (data.points.status == Status.UNFITTED)).sum()),
        rounds=rounds,
        calls=sum(step["tried"] for step in data.provenance["improvements"]),
        seconds=seconds,
    )


def _run_pointwise(config: RunConfig) -> RunResult:
    sensor = observer.sensor(config.space)
    lattice = Lattice(observer.axis_nodes("srgb", config.dim))
    start = time.perf_counter()
    problem = PointwiseProblem(Moments(config.coefficients), sensor, config.solver)
    fit = fit_pointwise(problem, lattice, config.threshold)
    seconds = time.perf_counter() - start
    return _evaluate(
        config,
        lattice.points,
        solid(sensor.matrix).contains(lattice.points),
        fit.distance,
        stand_ins=0,
        rounds=fit.rounds,
        calls=fit.starts - lattice.size,
        seconds=seconds,
    )


def _evaluate(
    config: RunConfig,
    points: Array,
    realisable: Mask,
    distance: Values,
    *,
    stand_ins: int,
    rounds: int,
    calls: int,
    seconds: float,
) -> RunResult:
    """Count the realisable points that failed, and find the worst."""
    of_realisable = np.where(realisable, distance, -1)
    worst = int(of_realisable.argmax())
    r, g, b = (float(value) for value in points[worst])
    return RunResult(
        config,
        points=len(points),
        realisable=int(realisable.sum()),
        unfitted=int((of_realisable > config.threshold).sum()),
        stand_ins=stand_ins,
        rounds=rounds,
        calls=calls,
        worst=float(of_realisable[worst]),
        r=r,
        g=g,
        b=b,
        seconds=seconds,
    )
