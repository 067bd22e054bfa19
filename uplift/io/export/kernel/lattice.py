"""The lookup: the nodes around a colour and their weighted sum, as in `uplift.lookup.interpolate`."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.io.export.kernel.intrinsics import (
        BIN_COUNT,
        BINS,
        BOXES,
        DIM,
        LISTS,
        NODES,
        Colour,
        Float,
        Int,
        Place,
        Sides,
        empty,
        number,
        tag,
    )


def cell(x: Float) -> Int:
    """Index of the last node up to x, for x in [0, 1]."""
    low: Int = int(number(BINS + int(x * float(BIN_COUNT))))
    while low < DIM - 2 and x >= number(NODES + low + 1):
        low += 1
    return low


def first_corner(rgb: Colour) -> Int:
    """Row of the lowest corner of a colour's cell."""
    return (cell(rgb[0]) * DIM + cell(rgb[1])) * DIM + cell(rgb[2])


def locate(rgb: Colour, place: Place) -> Int:
    """Find the entry in whose box a colour lies, or -1; set the colour and the weight of the lattice.

    Colours are clipped to [0, 1]; NaN becomes 0. In a box, x = (1 - t) e + t y, where the ray from the entry's colour e
    through x leaves the box at y. The lattice at y has weight t, the entry the rest.
    """
    for axis in range(3):
        place[axis] = (1.0 if rgb[axis] > 1.0 else rgb[axis]) if rgb[axis] > 0.0 else 0.0
    place[3] = 1.0
    query: Colour = empty(3)
    for axis in range(3):
        query[axis] = place[axis]
    entry: Int = -1
    listed: Int = int(tag(first_corner(query)))
    if listed > 0:
        last: Int = listed + int(number(LISTS + listed))
        while listed < last:
            listed += 1
            candidate: Int = int(number(LISTS + listed))
            box: Int = BOXES + 9 * candidate
            reached: Float = 0.0
            for axis in range(3):
                ray: Float = query[axis] - number(box + axis)
                part: Float = ray * number(box + 6 + axis) if ray > 0.0 else -ray * number(box + 3 + axis)
                reached = part if part > reached else reached
            if reached < 1.0:
                entry = candidate
                place[3] = reached
                listed = last
    if entry >= 0 and place[3] > 0.0:
        for axis in range(3):
            centre: Float = number(BOXES + 9 * entry + axis)
            leaves: Float = centre + (query[axis] - centre) / place[3]
            place[axis] = (1.0 if leaves > 1.0 else leaves) if leaves > 0.0 else 0.0
    return entry


def weigh(place: Place, sides: Sides) -> Int:
    """Set the weights of the lower and upper side of each axis; return the row of the lowest corner."""
    first: Int = 0
    for axis in range(3):
        low: Int = cell(place[axis])
        start: Float = number(NODES + low)
        share: Float = (place[axis] - start) / (number(NODES + low + 1) - start)
        sides[2 * axis] = 1.0 - share
        sides[2 * axis + 1] = share
        first = first * DIM + low
    return first
