"""Candidates from the least to the most, measured until one will do."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from uplift.scene.plan.evaluation import ErrorSummary


@dataclass(frozen=True)
class Trial:
    """A candidate that was measured.

    ``cost`` is told as ``told``; ``choice`` is what it stands for, in JSON values, and ``typed`` on the command line;
    ``error`` is that of the whole chain so far, all that was chosen before being in place.
    """

    name: str
    cost: float
    cost_text: str
    cli_args: str
    choice: Mapping[str, Any]
    error: ErrorSummary


@dataclass(frozen=True)
class Decision:
    """One thing decided: the ``trials`` in the order they were measured, and which of them was taken.

    ``limit`` is the ΔE00 that the chain so far was to stay within; where no trial did, the nearest was taken.
    """

    key: str
    title: str
    unit: str
    limit: float
    trials: tuple[Trial, ...]
    taken: int

    @property
    def trial(self) -> Trial:
        return self.trials[self.taken]

    @property
    def kept(self) -> bool:
        return self.trial.error.quantile <= self.limit


def decide(key: str, title: str, unit: str, limit: float, trials: Iterable[Trial]) -> Decision:
    """The first of the trials, which are made as they are asked for, that stays within the limit; else the nearest."""
    made: list[Trial] = []
    for trial in trials:
        made.append(trial)
        if trial.error.quantile <= limit:
            break
    errors = [trial.error.quantile for trial in made]
    taken = len(made) - 1 if errors[-1] <= limit else errors.index(min(errors))
    return Decision(key, title, unit, limit, tuple(made), taken)
