"""Spectra of the moments model in single precision, as in `uplift.models.moments`.

References
----------
Schur 1917, "Über Potenzreihen, die im Innern des Einheitskreises beschränkt sind": see `uplift.models.real_moments`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.io.export.kernel.intrinsics import (
        COUNT,
        ENTRY_COUNT,
        LOW,
        SCALE,
        WIDTH,
        Basis,
        Block,
        Bool,
        Coefficients,
        Float,
        Int,
        copysign,
        empty,
        number,
        unroll,
        warp,
        zeros,
    )


def sine_of_turn(x: Float) -> Float:
    """sin πx for x in [-1/2, 1/2], to 6e-8 of the value."""
    u: Float = x * x
    series: Float = 2.55006973 + u * (-0.59824213 + u * 0.07756039)
    return x * (3.14159264 + u * (-5.16770968 + u * series))


def deviation(weight: Float, x: Float) -> Float:
    """Weighted arctan(x) / π, to 6e-7, by arctan |x| = π/4 + arctan t: conditions would keep loops from vectorising."""
    size: Float = abs(x)
    t: Float = (size - 1.0) / (size + 1.0)
    u: Float = t * t
    high: Float = 0.0616058142 + u * -0.0370596857 + u * u * (0.0167581496 + u * -0.0037303064)
    return copysign(weight, x) * (0.25 + t * (0.318302635 + u * -0.105877136 + u * u * high))


def phase(wavelength: Float) -> Float:
    """Phase in turns, [-1/2, 1/2]; differences of magnitudes clip it to the range."""
    turn: Float = (warp(wavelength) - LOW) * SCALE - 0.5
    return 0.5 * (abs(turn + 0.5) - abs(turn - 0.5))


def argument(first: Int, wavelength: Float) -> Float:
    """Evaluate p_0 + 2 p_1 cos φ + ... of the multipliers from an index in the table."""
    cosine: Float = 2.0 * sine_of_turn(phase(wavelength))
    before: Float = 2.0
    now: Float = cosine
    held: Float = 0.0
    x: Float = number(first)
    for k in range(1, ENTRY_COUNT):
        x += now * number(first + k)
        held = now
        now = cosine * now - before
        before = held
    return x


def tabulate(wavelengths: Block, basis: Basis) -> None:
    """Tabulate 1, 2 cos φ, ..., 2 cos mφ at wavelengths in nm, order by order.

    The product of 2 cos jφ and 2 cos kφ is 2 cos (j + k)φ + 2 cos (j - k)φ.
    """
    for w in range(WIDTH):
        cosine: Coefficients = empty(COUNT)
        cosine[1] = 2.0 * sine_of_turn(phase(wavelengths[w]))
        for k in unroll(2, COUNT):
            cosine[k] = cosine[k // 2] * cosine[k - k // 2] - (2.0 if k % 2 == 0 else cosine[1])
        basis[w] = 1.0
        for k in unroll(1, COUNT):
            basis[k * WIDTH + w] = cosine[k]


def dual(moments: Coefficients, multipliers: Coefficients) -> Bool:
    """Compute multipliers of moments by Schur's algorithm; False where it breaks down.

    No branches: colours in the lanes of a register are computed together.
    """
    middle: Float = moments[0] - 0.5
    sine: Float = sine_of_turn(0.5 - abs(middle))
    cosine: Float = -sine_of_turn(middle)
    slope: Coefficients = empty(COUNT)
    even: Coefficients = zeros(COUNT)
    odd: Coefficients = zeros(COUNT)
    for k in unroll(1, COUNT):
        slope[k] = 3.14159265 * float(k) * moments[k]
        odd[k] = slope[k]
    even[0] = 1.0
    for order in unroll(1, COUNT):
        even[order] *= 1.0 / float(order)
        odd[order] *= 1.0 / float(order)
        for k in unroll(order + 1, COUNT):
            even[k] -= slope[k - order] * odd[order]
            odd[k] += slope[k - order] * even[order]
    upper: Coefficients = zeros(COUNT)
    lower: Coefficients = zeros(COUNT)
    for k in unroll(0, COUNT - 1):
        upper[k] = odd[k + 1]
        lower[k] = sine * even[k] + cosine * odd[k]
    first: Coefficients = zeros(COUNT)
    second: Coefficients = zeros(COUNT)
    first[0] = 1.0
    second[0] = 1.0
    room: Float = 0.25 - middle * middle
    scale: Float = 2.0
    g: Float = 0.0
    rest: Float = 0.0
    held: Float = 0.0
    for order in unroll(0, COUNT - 1):
        g = upper[0] / lower[0]
        rest = 1.0 - g * g
        room = rest if rest < room else room
        scale *= rest
        for k in unroll(0, COUNT - 2 - order):
            held = upper[k + 1] - g * lower[k + 1]
            lower[k] -= g * upper[k]
            upper[k] = held
        for k in unroll(0, order // 2 + 1):
            held = first[k]
            first[k] += g * first[order + 1 - k]
            first[order + 1 - k] += g * held
            held = second[k]
            second[k] -= g * second[order + 1 - k]
            second[order + 1 - k] -= g * held
        if order % 2 == 1:
            first[(order + 1) // 2] *= 1.0 + g
            second[(order + 1) // 2] *= 1.0 - g
    opposite: Float = sine if cosine > 0.0 else 1.0 - cosine
    adjacent: Float = 1.0 + cosine if cosine > 0.0 else sine
    first_weight: Float = opposite / (adjacent * scale)
    second_weight: Float = adjacent / (opposite * scale)
    first_sum: Float = 0.0
    second_sum: Float = 0.0
    for lag in unroll(0, COUNT):
        first_sum = first[0] * first[lag]
        second_sum = second[0] * second[lag]
        for k in unroll(1, COUNT - lag):
            first_sum += first[k] * first[k + lag]
            second_sum += second[k] * second[k + lag]
        multipliers[lag] = first_weight * first_sum - second_weight * second_sum
    return room > 0.0 and scale > 1e-30


def multipliers_of(coefficients: Coefficients, multipliers: Coefficients) -> Bool:
    """Compute multipliers, with as little grey as necessary; False, and those of a grey, if no spectrum fits."""
    moments: Coefficients = empty(COUNT)
    share: Float = 0.0
    for attempt in range(5):
        for k in range(COUNT):
            moments[k] = coefficients[k] * (1.0 - share)
        moments[0] += 0.5 * share
        if dual(moments, multipliers):
            return True
        share = 0.0000001 if attempt == 0 else share * 10.0
    for k in range(COUNT):
        multipliers[k] = 0.0
    return False
