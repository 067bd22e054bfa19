"""Wishes that a design does not fulfil, and what stands in their way, found by leaving out one thing at a time."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from uplift.design.palette.design import Design, design
from uplift.design.palette.matrix import difference, matrix, place
from uplift.design.palette.palette import Apart, Palette, Part, Wish

VISIBLE = 0.5
"""ΔE00 from which a colour counts as missed; about half of what is seen side by side."""
HELPS = 0.8
"""What does not bring the difference below this share of itself is no relief."""
MOST = 3
"""Reliefs that are named."""


@dataclass(frozen=True)
class Relief:
    """What to relax, and the ΔE00 that is left then."""

    what: str
    delta_e: float


@dataclass(frozen=True, eq=False)
class Miss:
    """A wish that is missed by so many ΔE00, and what would help, the most helpful first."""

    wish: Wish | Apart
    delta_e: float
    reliefs: tuple[Relief, ...] = ()

    def __str__(self) -> str:
        if isinstance(self.wish, Apart):
            first, second = self.wish.materials
            return (
                f"{first} and {second} under {self.wish.light}: ΔE00 {self.delta_e:.2f} apart, "
                f"not {self.wish.delta_e:g}; wish for colours that lie farther apart"
            )
        told = ", ".join(f"{relief.what} (then {relief.delta_e:.2f})" for relief in self.reliefs)
        return f"{self.wish}: missed by ΔE00 {self.delta_e:.2f}; " + (
            f"relax {told}" if told else "nothing that could be relaxed alone helps"
        )


def misses(found: Design) -> tuple[Miss, ...]:
    """All wishes that a design does not fulfil; where there are any, it is made anew without each other criterion."""
    colours, palette = matrix(found), found.palette
    far = [wish for wish in palette.wishes if wish.weight and colours.missed[place(found, wish)] > VISIBLE]
    others = [(what, matrix(design(other, found.model))) for what, other in _relaxed(palette)] if far else []
    missed = []
    for wish in far:
        at = place(found, wish)
        left = [Relief(what, float(other.missed[at])) for what, other in others if what != _weight_of(wish)]
        missed.append(Miss(wish, float(colours.missed[at]), _best(left, float(colours.missed[at]))))
    near = [(apart, difference(found, colours, apart)) for apart in palette.apart]
    return (*missed, *(Miss(apart, delta_e) for apart, delta_e in near if delta_e < apart.delta_e))


def _best(reliefs: list[Relief], delta_e: float) -> tuple[Relief, ...]:
    helpful = [relief for relief in reliefs if relief.delta_e < HELPS * delta_e]
    return tuple(sorted(helpful, key=lambda relief: relief.delta_e)[:MOST])


def _weight_of(wish: Wish) -> str:
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
    for wish in palette.wishes:
        if wish.weight:
            rest = tuple(
                dataclasses.replace(one, weight=0.0) if one is wish else one for one in palette.wishes
            )
            yield _weight_of(wish), dataclasses.replace(palette, wishes=rest)


def _without_bounds(palette: Palette, part: Part) -> Palette:
    """The palette with a part open to all values."""
    wide = dataclasses.replace(part, low=-math.inf, high=math.inf)

    def swapped(parts: tuple[Part, ...]) -> tuple[Part, ...]:
        return tuple(wide if one is part else one for one in parts)

    return dataclasses.replace(palette, lights=swapped(palette.lights), materials=swapped(palette.materials))
