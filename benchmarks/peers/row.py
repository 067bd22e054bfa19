"""A row of the comparison with other tools, and the check that precedes timing."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.lab.timing import Spread
from uplift.models import Model, Moments, Sigmoid, evaluate

THRESHOLD = 1e-4
"""Largest |linear RGB| between a fitted spectrum and its colour: the threshold of cubes."""


@dataclass(frozen=True)
class Answer:
    """Accuracy of fitted spectra: share within `THRESHOLD`, and the largest residual in |linear RGB|."""

    share: float
    worst: float


@dataclass(frozen=True)
class Peer:
    """CPU time in µs per node (all threads) and accuracy of a tool.

    ``model`` is 'sigmoid' or 'moments', ``count`` its number of coefficients. ``cpu`` and ``answer`` are None if the
    tool is not installed; ``notes`` then states it.
    """

    tool: str
    model: str
    count: int
    points: int
    cpu: Spread | None
    answer: Answer | None
    notes: str = ""

    def to_json(self) -> dict[str, Any]:
        """Return a row of docs/data/performance.json."""
        answer = dataclasses.asdict(self.answer) if self.answer else {"share": None, "worst": None}
        fields = {name: getattr(self, name) for name in ("tool", "model", "count", "points", "notes")}
        return fields | {"cpu_us": self.cpu} | answer


def missing(tool: str, what: str, model: str, count: int) -> Peer:
    """Return the row of a tool that needs ``what``, which is not installed."""
    return Peer(tool, model, count, 0, None, None, f"{what} is not installed")


def model_of(name: str, count: int) -> Model:
    return Sigmoid() if name == "sigmoid" else Moments(count)


def judge(rgb: ArrayLike, target: ArrayLike, *, least: float, within: float = THRESHOLD) -> Answer:
    """Compare linear RGB (n, 3) with ``target`` (n, 3).

    Raises
    ------
    RuntimeError : fewer than the share ``least`` come within ``within``. Some tools leave a few points unfitted, and
        their rows state how many; with more the timing means nothing.
    """
    residual = np.abs(np.asarray(rgb) - np.asarray(target)).max(axis=1)
    residual = np.where(np.isfinite(residual), residual, np.inf)
    share = float((residual <= within).mean())
    if share < least:
        raise RuntimeError(f"wrong answer, not timed: {share:.1%} of the points are within {within:g}")
    return Answer(float((residual <= THRESHOLD).mean()), float(residual.max()))


def judge_multipliers(model: Model, multipliers: Array, sensor: Sensor, target: Array, *, least: float) -> Answer:
    """`judge` the spectra with multipliers (n, C)."""
    return judge(sensor.rgb(evaluate(model, multipliers, sensor.wavelengths)), target, least=least)
