"""One line of the tables of peers, and the check that its answer is one worth timing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.lab.timing import Spread
from uplift.models import Model, Moments, Sigmoid, evaluate

THRESHOLD = 1e-4
"""Largest |linear RGB| by which a spectrum misses its colour and is counted as there: that of our cubes."""


@dataclass(frozen=True)
class Answer:
    """How well spectra have their colours: share within `THRESHOLD`, and the largest |linear RGB| of a miss."""

    share: float
    worst: float


@dataclass(frozen=True)
class Peer:
    """A tool at one task: µs of CPU per point (all threads), and how good what it found is.

    ``model`` is 'sigmoid' or 'moments', ``count`` its coefficients; ``cpu`` and ``answer`` are None where the tool
    is not installed, ``notes`` then says so.
    """

    tool: str
    model: str
    count: int
    points: int
    cpu: Spread | None
    answer: Answer | None
    notes: str = ""


def missing(tool: str, what: str, model: str, count: int) -> Peer:
    """The row of a tool whose ``what`` is not here: nothing was measured."""
    return Peer(tool, model, count, 0, None, None, f"{what} is not installed")


def model_of(name: str, count: int) -> Model:
    return Sigmoid() if name == "sigmoid" else Moments(count)


def judge(rgb: ArrayLike, target: ArrayLike, *, least: float, within: float = THRESHOLD) -> Answer:
    """Compare linear RGB (n, 3) with ``target`` (n, 3).

    Raises
    ------
    RuntimeError : fewer than the share ``least`` come within ``within``. Some peers leave points, and their rows
        say how many; one that leaves more is not doing what it is timed for.
    """
    missed = np.abs(np.asarray(rgb) - np.asarray(target)).max(axis=1)
    missed = np.where(np.isfinite(missed), missed, np.inf)
    there = float((missed <= within).mean())
    if there < least:
        raise RuntimeError(f"a wrong answer is not worth timing: {there:.1%} of the points within {within:g}")
    return Answer(float((missed <= THRESHOLD).mean()), float(missed.max()))


def judge_multipliers(
    model: Model, multipliers: Array, sensor: Sensor, target: Array, *, least: float
) -> Answer:
    """`judge` the spectra with multipliers (n, C)."""
    return judge(sensor.rgb(evaluate(model, multipliers, sensor.wavelengths)), target, least=least)
