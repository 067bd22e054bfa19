"""Goals that a design of a palette misses, and the criteria whose relaxation helps."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from operator import itemgetter
from typing import Any

import numpy as np

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.arrays import Array
from uplift.extras.papers.palette.design import Design, design, matrix
from uplift.extras.papers.palette.palette import (
    ColourGoal,
    MinDifference,
    Palette,
)

# ΔE00 above which a goal is missed: about half of a difference that is visible side by
# side
MISSED = 0.5
MAX_REMAINING = 0.8  # fraction of the ΔE00 that a useful relaxation may leave
MAX_RELAXATIONS = 3  # relaxations that are listed for a goal


@dataclass(frozen=True, eq=False)
class UnmetGoal:
    """A goal that a design misses."""

    goal: ColourGoal | MinDifference
    delta_e: float  # ΔE00 from the target, or between the materials
    # Names of the criteria to relax, the most effective first, and the ΔE00 of the goal
    # without them.
    relaxations: tuple[tuple[str, float], ...] = ()

    def __str__(self) -> str:
        if isinstance(self.goal, MinDifference):
            first, second = self.goal.materials
            return (
                f"{first} and {second} under {self.goal.light}: ΔE00 must be at least "
                f"{self.goal.delta_e:g}, "
                f"got {self.delta_e:.2f}; choose colours that differ more"
            )
        criteria = ", ".join(
            f"{name} (then {remaining:.2f})" for name, remaining in self.relaxations
        )
        hint = f"relax {criteria}" if criteria else "no single criterion is responsible"
        return f"{self.goal}: missed by ΔE00 {self.delta_e:.2f}; {hint}"


def unmet_goals(found: Design) -> tuple[UnmetGoal, ...]:
    """Find the goals that a design misses. The palette is designed again without each
    criterion in turn.

    Parameters
    ----------
    found : Design
        The design.

    Returns
    -------
    tuple of UnmetGoal
        Colours missed by a visible difference, then differences that are too small.
    """
    colours = matrix(found)
    palette = found.palette
    errors = {
        goal: float(colours.delta_e[palette.cell(goal.material, goal.light)])
        for goal in palette.goals
    }
    missed = [goal for goal in palette.goals if goal.weight and errors[goal] > MISSED]
    relaxed = []
    for name, changed in _relaxed(palette) if missed else ():
        relaxed.append((name, matrix(design(changed, found.model)).delta_e))
    unmet = []
    for goal in missed:
        cell = palette.cell(goal.material, goal.light)
        useful = []
        for name, remaining in relaxed:
            is_other = name != _weight_of(goal)
            if is_other and remaining[cell] < MAX_REMAINING * errors[goal]:
                useful.append((name, float(remaining[cell])))
        useful.sort(key=itemgetter(1))
        unmet.append(UnmetGoal(goal, errors[goal], tuple(useful[:MAX_RELAXATIONS])))
    return (*unmet, *_too_alike(palette, colours.fitted))


def _too_alike(palette: Palette, colours: Array) -> Iterator[UnmetGoal]:
    """Yield the pairs of materials whose colours differ too little."""
    for pair in palette.min_differences:
        both = [colours[palette.cell(name, pair.light)] for name in pair.materials]
        delta_e = float(delta_e_rgb(palette.sensor, *both))
        if delta_e < pair.delta_e:
            yield UnmetGoal(pair, delta_e)


def _weight_of(goal: ColourGoal) -> str:
    return f"the weight of {goal}"


def _relaxed(palette: Palette) -> Iterator[tuple[str, Palette]]:
    """Yield the name of each criterion, and the palette without it."""
    if palette.smoothness:
        yield "smoothness", replace(palette, smoothness=0.0)
    if palette.model_error:
        yield "model-error", replace(palette, model_error=0.0)
    for name in palette.free:
        unbounded = (np.full(3, -np.inf), np.full(3, np.inf))
        yield (
            f"the range of {name}",
            replace(palette, free={**palette.free, name: unbounded}),
        )
    for spec in (*palette.lights, *palette.materials):
        if spec.designed and (math.isfinite(spec.low) or math.isfinite(spec.high)):
            free = replace(spec, low=-math.inf, high=math.inf)
            without = replace(
                palette,
                lights=_replaced(palette.lights, spec, free),
                materials=_replaced(palette.materials, spec, free),
            )
            yield f"the bounds of {spec.name}", without
    for goal in palette.goals:
        if goal.weight:
            weightless = replace(goal, weight=0.0)
            goals = _replaced(palette.goals, goal, weightless)
            yield _weight_of(goal), replace(palette, goals=goals)


def _replaced(items: tuple[Any, ...], old: object, new: object) -> tuple[Any, ...]:
    return tuple(new if item is old else item for item in items)
