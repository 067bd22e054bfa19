"""Progress of long work: one event type and one callback type for every layer."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Progress:
    """Work done so far: ``done`` of ``total`` items of a stage such as ``"fit"``, in a
    ``step``.

    ``detail`` is one line for verbose output.
    """

    stage: str
    done: int
    total: int
    step: int = 0
    detail: str = ""


ProgressCallback = Callable[[Progress], None]


def ignore_progress(progress: Progress) -> None:
    """Do nothing: the default callback."""
