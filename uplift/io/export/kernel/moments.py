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
        SPAN,
        WIDTH,
        Basis,
        Block,
        Bool,
        Coefficients,
        Float,
        Int,
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


def squash(x: Float) -> Float:
    """1/2 + arctan(x) / π, to 1e-7, by arctan |x| = π/4 + arctan t: conditions would keep loops from vectorising."""
    size: Float = abs(x)
    sign: Float = 1.0 if x > 0.0 else -1.0
    t: Float = (size - 1.0) / (size + 1.0)
    u: Float = t * t
    series: Float = 0.03155817 + u * (-0.0189351 + u * (0.00771978 + u * -0.00149392))
    angle: Float = t * (0.31830985 + u * (-0.10609902 + u * (0.06356561 + u * (-0.04462539 + u * series))))
    return 0.5 + sign * (0.25 + angle)


def phase(wavelength: Float) -> Float:
    """Phase in turns, [-1/2, 1/2]; differences of magnitudes clip it to the range."""
    turn: Float = (warp(wavelength) - LOW) / SPAN - 0.5
    return 0.5 * (abs(turn + 0.5) - abs(turn - 0.5))


def argument(first: Int, wavelength: Float) -> Float:
    """Evaluate p_0 + 2 p_1 cos φ + ... of the multipliers from an index in the table."""
    turn: Float = phase(wavelength)
    cosine: Float = sine_of_turn(turn)
    sine: Float = -sine_of_turn(0.5 - abs(turn))
    real: Float = 1.0
    imaginary: Float = 0.0
    held: Float = 0.0
    x: Float = number(first)
    for k in range(1, ENTRY_COUNT):
        held = real * cosine - imaginary * sine
        imaginary = real * sine + imaginary * cosine
        real = held
        x += 2.0 * real * number(first + k)
    return x


def tabulate(wavelengths: Block, basis: Basis) -> None:
    """Tabulate 1, 2 cos φ, ..., 2 cos mφ at wavelengths in nm, order by order."""
    for w in range(WIDTH):
        turn: Float = phase(wavelengths[w])
        cosine: Coefficients = zeros(COUNT)
        sine: Coefficients = zeros(COUNT)
        cosine[1] = sine_of_turn(turn)
        sine[1] = -sine_of_turn(0.5 - abs(turn))
        for k in unroll(2, COUNT):
            cosine[k] = cosine[k // 2] * cosine[k - k // 2] - sine[k // 2] * sine[k - k // 2]
            sine[k] = cosine[k // 2] * sine[k - k // 2] + sine[k // 2] * cosine[k - k // 2]
        basis[w] = 1.0
        for k in unroll(1, COUNT):
            basis[k * WIDTH + w] = 2.0 * cosine[k]


def dual(moments: Coefficients, multipliers: Coefficients) -> Bool:
    """Compute multipliers of moments by Schur's algorithm; False where it breaks down."""
    middle: Float = moments[0] - 0.5
    if not (middle > -0.5 and middle < 0.5):
        return False
    sine: Float = sine_of_turn(0.5 - abs(middle))
    cosine: Float = -sine_of_turn(middle)
    slope: Coefficients = zeros(COUNT)
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
    scale: Float = 1.0
    g: Float = 0.0
    held: Float = 0.0
    for order in unroll(0, COUNT - 1):
        g = upper[0] / lower[0]
        if not 1.0 - g * g > 0.0:
            return False
        scale *= 1.0 - g * g
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
    tangent: Float = sine / (1.0 + cosine) if cosine > 0.0 else (1.0 - cosine) / sine
    first_weight: Float = tangent / (2.0 * scale)
    second_weight: Float = 1.0 / (2.0 * scale * tangent)
    first_sum: Float = 0.0
    second_sum: Float = 0.0
    for lag in unroll(0, COUNT):
        first_sum = first[0] * first[lag]
        second_sum = second[0] * second[lag]
        for k in unroll(1, COUNT - lag):
            first_sum += first[k] * first[k + lag]
            second_sum += second[k] * second[k + lag]
        multipliers[lag] = first_weight * first_sum - second_weight * second_sum
    return True


def multipliers_of(coefficients: Coefficients, multipliers: Coefficients) -> Bool:
    """Compute multipliers, with as little grey as necessary; False, and those of a grey, if no spectrum fits."""
    moments: Coefficients = zeros(COUNT)
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
