"""Progress of long work: one event type and one callback type for every layer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Progress:
    """Work done so far in one stage.

    Parameters
    ----------
    stage : str
        Name of the stage, such as ``"fit"``, ``"store"`` or ``"images"``.
    done, total : int
        Items finished in this stage, and items in all.
    step : int, optional
        Step within the stage, such as the round of growth.
    detail : str, optional
        One line for verbose output.
    """

    stage: str
    done: int
    total: int
    step: int = 0
    detail: str = ""


ProgressCallback = Callable[[Progress], None]


def ignore_progress(progress: Progress) -> None:
    """Do nothing: the default callback."""
