"""Numbers, times, sizes and counts as text."""

import math
from collections.abc import Iterable, Sequence

from uplift.common.text import pluralise

__all__ = [
    "capitalise",
    "format_build_time",
    "format_error",
    "format_power_of_ten",
    "format_rgb",
    "format_scientific",
    "format_size",
    "format_time",
    "pluralise",
]

TIME_UNITS = ((1e9, "s"), (1e6, "ms"), (1e3, "µs"), (1.0, "ns"))
SIZE_UNITS = ((1e9, "GB"), (1e6, "MB"), (1e3, "kB"), (1.0, "B"))
SMALLEST_ERROR = 1e-4  # errors below this are not visible
SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def format_time(ns: float) -> str:
    """Format a time in ns with three digits and its unit."""
    return _with_unit(ns, TIME_UNITS)


def format_size(size: float) -> str:
    """Format a number of bytes with three digits and a decimal unit."""
    return _with_unit(size, SIZE_UNITS)


def format_error(error: float) -> str:
    """Format a ΔE00 or an rms with three digits, below 0.01 with four decimals."""
    if error < SMALLEST_ERROR:
        return f"< {SMALLEST_ERROR:.4f}"
    return f"{error:.4f}" if error < 0.01 else f"{error:.3g}"


def format_build_time(seconds: float | None) -> str:
    """Format the seconds that a build takes: ``nothing`` for 0, empty for None."""
    if seconds is None:
        return ""
    return format_time(seconds * 1e9) if seconds else "nothing"


def format_scientific(value: float) -> str:
    """Format a number with three digits, or as a product with a power of ten."""
    if not math.isfinite(value):
        return "not finite"
    if value == 0:
        return "0"
    if 1e-2 <= abs(value) < 1e3:
        return f"{value:#.3g}".rstrip(".")
    digits, exponent = f"{value:.1e}".split("e")
    return f"{digits}\u00a0×\u00a0{_power_of_ten(int(exponent))}"


def format_power_of_ten(value: float) -> str:
    """Format the power of ten nearest to a value, as axis labels show it."""
    return _power_of_ten(round(math.log10(value)))


def format_rgb(rgb: Iterable[float]) -> str:
    """Format linear RGB (3,) with four decimals."""
    return ", ".join(f"{value:.4f}" for value in rgb)


def capitalise(text: str) -> str:
    """Turn the first letter into a capital and keep all others."""
    return text[:1].upper() + text[1:]


def _with_unit(value: float, units: Sequence[tuple[float, str]]) -> str:
    factor, unit = next(
        (pair for pair in units if value >= pair[0] * 0.9995), units[-1]
    )
    number = value / factor
    return f"{number:.3g} {unit}" if number < 999.5 else f"{number:,.0f} {unit}"


def _power_of_ten(exponent: int) -> str:
    return f"10{str(exponent).translate(SUPERSCRIPT)}"
