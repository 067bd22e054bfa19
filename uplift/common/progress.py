"""Progress of long work: one event type and one callback type for every layer."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

Item = TypeVar("Item")


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


def reported(
    items: Sequence[Item], stage: str, progress: ProgressCallback
) -> Iterator[Item]:
    """Yield items, and report each one when it is done."""
    for done, item in enumerate(items, 1):
        yield item
        progress(Progress(stage, done, len(items)))
