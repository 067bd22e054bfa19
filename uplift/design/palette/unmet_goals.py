"""Wishes that a design does not fulfil, and what stands in their way, found by leaving out one thing at a time."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from uplift.design.palette.design import Design, design
from uplift.design.palette.matrix import difference, matrix, place
from uplift.design.palette.palette import ColourGoal, MinDifference, Palette, SpectrumSpec

VISIBLE = 0.5
"""ΔE00 from which a colour counts as missed; about half of what is seen side by side."""
HELPS = 0.8
"""What does not bring the difference below this share of itself is no relief."""
MOST = 3
"""Reliefs that are named."""


@dataclass(frozen=True)
class Relaxation:
    """What to relax, and the ΔE00 that is left then."""

    criterion: str
    delta_e: float


@dataclass(frozen=True, eq=False)
class UnmetGoal:
    """A wish that is missed by so many ΔE00, and what would help, the most helpful first."""

    goal: ColourGoal | MinDifference
    delta_e: float
    relaxations: tuple[Relaxation, ...] = ()

    def __str__(self) -> str:
        if isinstance(self.goal, MinDifference):
            first, second = self.goal.materials
            return (
                f"{first} and {second} under {self.goal.light}: ΔE00 {self.delta_e:.2f} apart, "
                f"not {self.goal.delta_e:g}; wish for colours that lie farther apart"
            )
        told = ", ".join(f"{relief.criterion} (then {relief.delta_e:.2f})" for relief in self.relaxations)
        return f"{self.goal}: missed by ΔE00 {self.delta_e:.2f}; " + (
            f"relax {told}" if told else "nothing that could be relaxed alone helps"
        )


def unmet_goals(found: Design) -> tuple[UnmetGoal, ...]:
    """All wishes that a design does not fulfil; where there are any, it is made anew without each other criterion."""
    colours, palette = matrix(found), found.palette
    far = [wish for wish in palette.goals if wish.weight and colours.delta_e[place(found, wish)] > VISIBLE]
    others = [(what, matrix(design(other, found.model))) for what, other in _relaxed(palette)] if far else []
    missed = []
    for wish in far:
        at = place(found, wish)
        left = [
            Relaxation(what, float(other.delta_e[at])) for what, other in others if what != _weight_of(wish)
        ]
        missed.append(UnmetGoal(wish, float(colours.delta_e[at]), _best(left, float(colours.delta_e[at]))))
    near = [(apart, difference(found, colours, apart)) for apart in palette.min_differences]
    return (*missed, *(UnmetGoal(apart, delta_e) for apart, delta_e in near if delta_e < apart.delta_e))


def _best(reliefs: list[Relaxation], delta_e: float) -> tuple[Relaxation, ...]:
    helpful = [relief for relief in reliefs if relief.delta_e < HELPS * delta_e]
    return tuple(sorted(helpful, key=lambda relief: relief.delta_e)[:MOST])


def _weight_of(wish: ColourGoal) -> str:
    return f"the weight of {wish}"


def _relaxed(palette: Palette) -> Iterator[tuple[str, Palette]]:
    """The palette without one of its criteria at a time, and what that is called."""
    if palette.smoothness:
        yield "smoothness", dataclasses.replace(palette, smoothness=0.0)
    if palette.model_error:
        yield "model-error", dataclasses.replace(palette, model_error=0.0)
    for name in palette.free:
        wide = (np.full(3, -np.inf), np.full(3, np.inf))
        yield f"the range of {name}", dataclasses.replace(palette, free={**palette.free, name: wide})
    for part in (*palette.lights, *palette.materials):
        if part.designed and (math.isfinite(part.low) or math.isfinite(part.high)):
            yield f"the bounds of {part.name}", _without_bounds(palette, part)
    for wish in palette.goals:
        if wish.weight:
            rest = tuple(
                dataclasses.replace(one, weight=0.0) if one is wish else one for one in palette.goals
            )
            yield _weight_of(wish), dataclasses.replace(palette, goals=rest)


def _without_bounds(palette: Palette, part: SpectrumSpec) -> Palette:
    """The palette with a part open to all values."""
    wide = dataclasses.replace(part, low=-math.inf, high=math.inf)

    def swapped(parts: tuple[SpectrumSpec, ...]) -> tuple[SpectrumSpec, ...]:
        return tuple(wide if one is part else one for one in parts)

    return dataclasses.replace(palette, lights=swapped(palette.lights), materials=swapped(palette.materials))
