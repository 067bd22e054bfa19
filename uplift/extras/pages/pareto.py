"""Pareto fronts: panels of error over cost on logarithmic axes."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from uplift.extras.pages.figure import INK, OTHER
from uplift.extras.pages.marks import Mark
from uplift.extras.pages.panels import Axis, Dot, Panel

CLEAR_RATIO = 0.99
"""Share of an error below which another one is clearly smaller; the rest is noise."""


def pareto_front(points: Sequence[tuple[float, float]]) -> list[int]:
    """Return the rows of cost and error whose error is clearly below that of every
    cheaper one, cheapest first.
    """
    front: list[int] = []
    for row in sorted(range(len(points)), key=points.__getitem__):
        if not front or points[row][1] < CLEAR_RATIO * points[front[-1]][1]:
            front.append(row)
    return front


def front_panel(
    title: str,
    cost: Axis,
    named: Sequence[Dot],
    unnamed: Sequence[Dot] = (),
    marks: Sequence[Mark] = (),
) -> Panel:
    """Return a panel of error over cost with the Pareto front; dots that are
    ``unnamed`` have their texts only on the front.
    """
    dots = [*unnamed, *named]
    rows = pareto_front([(dot.x, dot.y) for dot in dots])
    drawn = []
    for row, dot in enumerate(dots):
        if row in rows:
            drawn.append(replace(dot, bold=True))
        elif row < len(unnamed):
            drawn.append(replace(dot, text=""))
        else:
            drawn.append(dot)
    front = _staircase([dots[row] for row in rows])
    return Panel([*marks, front], title, cost, Axis(log=True), drawn)


def _staircase(front: Sequence[Dot]) -> Mark:
    """Draw the corners of a front, up to the right end of the axes."""

    def draw(axes: Any) -> None:
        x = np.append(np.repeat([dot.x for dot in front], 2)[1:], axes.get_xlim()[1])
        y = np.repeat([dot.y for dot in front], 2)
        style: dict[str, Any] = {"color": INK, "linewidth": 1.1, "zorder": 1}
        axes.plot(x[: len(y)], y, scalex=False, label="Pareto front", **style)

    return draw


def family_colours(families: Iterable[str], known: Mapping[str, str]) -> dict[str, str]:
    """``#rrggbb`` of families in the order of the known ones; others are dark grey."""
    present = dict.fromkeys(families)
    return {
        name: known.get(name, OTHER)
        for name in sorted(present, key=[*known, *sorted(present)].index)
    }
