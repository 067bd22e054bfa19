"""The lookup of lights: the cell of a chromaticity, the lamps around it, and power, as in `uplift.lights.lookup`."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.io.export.kernel.intrinsics import (
        ANGLES,
        BIN_COUNT,
        BINS,
        INVERSES,
        KNOTS,
        LAMP_SPECTRA,
        LAMPS,
        MATRIX,
        RING_SHARES,
        RINGS,
        SAMPLES,
        START,
        STEP,
        WHITE,
        WIDTH,
        Block,
        Colour,
        Float,
        Int,
        Offset,
        Spot,
        empty,
        number,
        sqrt,
    )


def angle(u: Float, v: Float) -> Float:
    """Increase counterclockwise from the first knot, from 0 to 4."""
    length: Float = abs(u) + abs(v)
    slope: Float = u / length if length > 0.0 else 1.0
    turned: Float = (3.0 + slope if v < 0.0 else 1.0 - slope) - number(WHITE + 2)
    return turned + 4.0 if turned < 0.0 else turned


def sector(u: Float, v: Float) -> Int:
    """Index of the knot before a direction from white."""
    sought: Float = angle(u, v)
    low: Int = 0
    high: Int = KNOTS
    while low + 1 < high:
        middle: Int = (low + high) // 2
        is_before: Float = 1.0 if number(ANGLES + middle) <= sought else 0.0
        low = middle if is_before > 0.5 else low
        high = high if is_before > 0.5 else middle
    return low


def along(knot: Int, u: Float, v: Float, which: Int) -> Float:
    """Share of an offset from white that the first or the second spoke of a sector has."""
    share: Float = number(INVERSES + 4 * knot + 2 * which) * u + number(INVERSES + 4 * knot + 2 * which + 1) * v
    return share if share > 0.0 else 0.0


def clip(rgb: Colour, offset: Offset) -> None:
    """Set u', v' from white and X + 15 Y + 3 Z of a light; a colour that no light has moves towards white."""
    for row in range(4):
        offset[row] = 0.0
        for column in range(3):
            finite: Float = rgb[column] if abs(rgb[column]) < 1e30 else 0.0
            offset[row] += number(MATRIX + 3 * row + column) * finite
    knot: Int = sector(offset[0], offset[1])
    share: Float = along(knot, offset[0], offset[1], 0) + along(knot, offset[0], offset[1], 1)
    size: Float = offset[2]
    if size <= 0.0 or share > size:
        white: Float = offset[3] if offset[3] > 0.0 else 0.0
        reach: Float = share + white - size
        step: Float = white / reach if reach > 0.0 else 0.0
        size = step * share
        offset[0] *= step
        offset[1] *= step
    offset[0] = offset[0] / size if size > 0.0 else 0.0
    offset[1] = offset[1] / size if size > 0.0 else 0.0
    offset[2] = size


def lamp_at(offset: Offset, spot: Spot) -> Int:
    """Find the lamp in whose disc a chromaticity lies, or -1; set the share of the lamp, and move to the circle."""
    u: Float = offset[0] + number(WHITE)
    v: Float = offset[1] + number(WHITE + 1)
    column: Int = int(u * float(BIN_COUNT))
    row: Int = int(v * float(BIN_COUNT))
    column = column if column < BIN_COUNT - 1 else BIN_COUNT - 1
    row = row if row < BIN_COUNT - 1 else BIN_COUNT - 1
    listed: Int = int(number(BINS + row * BIN_COUNT + column))
    last: Int = listed + int(number(BINS + listed))
    found: Int = -1
    while listed < last:
        listed += 1
        candidate: Int = int(number(BINS + listed))
        away_u: Float = u - number(LAMPS + 3 * candidate)
        away_v: Float = v - number(LAMPS + 3 * candidate + 1)
        radius: Float = number(LAMPS + 3 * candidate + 2)
        distance: Float = sqrt(away_u * away_u + away_v * away_v)
        if distance < radius:
            found = candidate
            spot[3] = 1.0 - distance / radius
            reach: Float = radius / distance if distance > 0.0 else 0.0
            turn: Float = 0.0 if distance > 0.0 else radius
            offset[0] = number(LAMPS + 3 * candidate) + away_u * reach + turn - number(WHITE)
            offset[1] = number(LAMPS + 3 * candidate + 1) + away_v * reach - number(WHITE + 1)
            listed = last
    return found


def locate(rgb: Colour, spot: Spot) -> Int:
    """Set positions in the cell, size, share and number of the lamp, and lowest corner; return the lowest corner.

    Colours that no light has are moved towards white of the same luminance; NaN and infinity become 0.
    """
    offset: Offset = empty(4)
    clip(rgb, offset)
    spot[2] = offset[2]
    spot[3] = 0.0
    spot[4] = float(lamp_at(offset, spot))
    knot: Int = sector(offset[0], offset[1])
    second: Float = along(knot, offset[0], offset[1], 1)
    share: Float = along(knot, offset[0], offset[1], 0) + second
    spot[0] = second / share if share > 0.0 else 0.0
    share = share if share < 1.0 else 1.0
    ring: Int = 0
    while ring < RINGS - 2 and share >= number(RING_SHARES + ring + 1):
        ring += 1
    first: Float = number(RING_SHARES + ring)
    spot[1] = (share - first) / (number(RING_SHARES + ring + 1) - first)
    return (knot * RINGS + ring) * SAMPLES


def sample(row: Int, share: Float) -> Float:
    """Interpolate between a number of the table and the turned one."""
    first: Float = number(row)
    return first + share * (number(row + 1) - first)


def answer(spot: Spot, corner: Int, wavelengths: Block, total: Block) -> None:
    """Power at wavelengths in nm; linear between samples, constant outside."""
    lamp: Int = int(spot[4])
    for w in range(WIDTH):
        place: Float = (wavelengths[w] - START) / STEP
        place = place if place > 0.0 else 0.0
        low: Int = int(place) if place < float(SAMPLES - 1) else SAMPLES - 2
        share: Float = place - float(low) if place < float(SAMPLES - 1) else 1.0
        at: Int = corner + low
        turned: Int = at + RINGS * SAMPLES
        before: Float = sample(at, share) + spot[1] * (sample(at + SAMPLES, share) - sample(at, share))
        after: Float = sample(turned, share) + spot[1] * (sample(turned + SAMPLES, share) - sample(turned, share))
        power: Float = before + spot[0] * (after - before)
        if lamp >= 0:
            power += spot[3] * (sample(LAMP_SPECTRA + lamp * SAMPLES + low, share) - power)
        total[w] = spot[2] * power
