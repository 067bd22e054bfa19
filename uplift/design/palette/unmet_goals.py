"""Goals that a design misses, and the constraints whose removal would help."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from uplift.design.palette.design import Design, design
from uplift.design.palette.matrix import cell_index, difference, matrix
from uplift.design.palette.palette import ColourGoal, MinDifference, Palette, SpectrumSpec

VISIBLE = 0.5
"""ΔE00 above which a goal is missed: about half of a difference that is visible side by side."""
MAX_REMAINING = 0.8
"""Share of the ΔE00 that a useful relaxation may leave."""
MAX_RELAXATIONS = 3
"""Relaxations that are listed for a goal."""


@dataclass(frozen=True)
class Relaxation:
    """A criterion whose removal reduces the error of a goal.

    Parameters
    ----------
    criterion : str
        Name of the criterion.
    delta_e : float
        ΔE00 of the goal without it.
    """

    criterion: str
    delta_e: float


@dataclass(frozen=True, eq=False)
class UnmetGoal:
    """A goal that a design misses.

    Parameters
    ----------
    goal : ColourGoal or MinDifference
        The goal.
    delta_e : float
        ΔE00 from the target, or between the materials.
    relaxations : tuple of Relaxation
        Criteria to relax, the most effective first.
    """

    goal: ColourGoal | MinDifference
    delta_e: float
    relaxations: tuple[Relaxation, ...] = ()

    def __str__(self) -> str:
        if isinstance(self.goal, MinDifference):
            first, second = self.goal.materials
            return (
                f"{first} and {second} under {self.goal.light}: ΔE00 must be at least {self.goal.delta_e:g}, "
                f"got {self.delta_e:.2f}; choose colours that differ more"
            )
        criteria = ", ".join(f"{each.criterion} (then {each.delta_e:.2f})" for each in self.relaxations)
        hint = f"relax {criteria}" if criteria else "no single criterion is responsible"
        return f"{self.goal}: missed by ΔE00 {self.delta_e:.2f}; {hint}"


def unmet_goals(found: Design) -> tuple[UnmetGoal, ...]:
    """Find the goals that a design misses. The palette is designed again without each criterion in turn.

    Parameters
    ----------
    found : Design
        The design.

    Returns
    -------
    tuple of UnmetGoal
        Missed colours, then differences that are too small; empty if all goals are met.
    """
    colours, palette = matrix(found), found.palette
    missed = [goal for goal in palette.goals if goal.weight and colours.delta_e[cell_index(found, goal)] > VISIBLE]
    relaxed = [(name, matrix(design(each, found.model)).delta_e) for name, each in _relaxed(palette)] if missed else []
    unmet = []
    for goal in missed:
        cell = cell_index(found, goal)
        others = [Relaxation(name, float(errors[cell])) for name, errors in relaxed if name != _weight_of(goal)]
        delta_e = float(colours.delta_e[cell])
        unmet.append(UnmetGoal(goal, delta_e, _most_effective(others, delta_e)))
    differences = [(pair, difference(found, colours, pair)) for pair in palette.min_differences]
    return (*unmet, *(UnmetGoal(pair, delta_e) for pair, delta_e in differences if delta_e < pair.delta_e))


def _most_effective(relaxations: list[Relaxation], delta_e: float) -> tuple[Relaxation, ...]:
    useful = [each for each in relaxations if each.delta_e < MAX_REMAINING * delta_e]
    return tuple(sorted(useful, key=lambda each: each.delta_e)[:MAX_RELAXATIONS])


def _weight_of(goal: ColourGoal) -> str:
    return f"the weight of {goal}"


def _relaxed(palette: Palette) -> Iterator[tuple[str, Palette]]:
    """Name of each criterion, and the palette without it."""
    if palette.smoothness:
        yield "smoothness", dataclasses.replace(palette, smoothness=0.0)
    if palette.model_error:
        yield "model-error", dataclasses.replace(palette, model_error=0.0)
    for name in palette.free:
        unbounded = (np.full(3, -np.inf), np.full(3, np.inf))
        yield f"the range of {name}", dataclasses.replace(palette, free={**palette.free, name: unbounded})
    for spec in (*palette.lights, *palette.materials):
        if spec.designed and (math.isfinite(spec.low) or math.isfinite(spec.high)):
            yield f"the bounds of {spec.name}", _without_bounds(palette, spec)
    for goal in palette.goals:
        if goal.weight:
            others = (dataclasses.replace(each, weight=0.0) if each is goal else each for each in palette.goals)
            yield _weight_of(goal), dataclasses.replace(palette, goals=tuple(others))


def _without_bounds(palette: Palette, spec: SpectrumSpec) -> Palette:
    unbounded = dataclasses.replace(spec, low=-math.inf, high=math.inf)

    def replaced(specs: tuple[SpectrumSpec, ...]) -> tuple[SpectrumSpec, ...]:
        return tuple(unbounded if each is spec else each for each in specs)

    lights, materials = replaced(palette.lights), replaced(palette.materials)
    return dataclasses.replace(palette, lights=lights, materials=materials)
