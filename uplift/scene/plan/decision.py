"""Choice of the cheapest sufficient candidate."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from uplift.scene.plan.evaluation import ErrorSummary


@dataclass(frozen=True)
class Trial:
    """A candidate and its measured error.

    Parameters
    ----------
    name : str
        Short name for tables.
    cost : float
        Quantity that candidates are ordered by.
    cost_text : str
        The cost with its unit.
    cli_args : str
        Options of the command line that select the candidate.
    choice : mapping
        The candidate in JSON values.
    error : ErrorSummary
        Error of the chain up to this decision, with all earlier decisions applied.
    """

    name: str
    cost: float
    cost_text: str
    cli_args: str
    choice: Mapping[str, Any]
    error: ErrorSummary


@dataclass(frozen=True)
class Decision:
    """Candidates of one kind and the selected one.

    Parameters
    ----------
    key : str
        Identifier.
    title, unit : str
        Heading, and unit of the cost.
    limit : float
        Largest ΔE00 of the chain after this decision.
    trials : tuple of Trial
        Candidates in the order in which they were measured.
    selected : int
        Index of the selected trial: the first within the limit, or else the one of the smallest error.
    """

    key: str
    title: str
    unit: str
    limit: float
    trials: tuple[Trial, ...]
    selected: int

    @property
    def trial(self) -> Trial:
        """The selected trial."""
        return self.trials[self.selected]

    @property
    def within_limit(self) -> bool:
        """Whether the selected trial meets the limit."""
        return self.trial.error.quantile <= self.limit


def decide(key: str, title: str, unit: str, limit: float, trials: Iterable[Trial]) -> Decision:
    """Measure candidates up to the first within the limit. ``trials`` makes each one when it is requested."""
    measured: list[Trial] = []
    for trial in trials:
        measured.append(trial)
        if trial.error.quantile <= limit:
            break
    errors = [trial.error.quantile for trial in measured]
    selected = len(errors) - 1 if errors[-1] <= limit else errors.index(min(errors))
    return Decision(key, title, unit, limit, tuple(measured), selected)
