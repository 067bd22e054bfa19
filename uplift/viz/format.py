"""Times, sizes and errors as people read them."""

from __future__ import annotations

TIMES = ((1e9, "s"), (1e6, "ms"), (1e3, "µs"), (1.0, "ns"))
SIZES = ((1e9, "GB"), (1e6, "MB"), (1e3, "kB"), (1.0, "B"))


def format_time(ns: float) -> str:
    """70 ns, 4.2 µs, 1 s."""
    return _told(ns, TIMES)


def format_size(size: float) -> str:
    """560 B, 18.9 MB."""
    return _told(size, SIZES)


def format_error(error: float) -> str:
    """Three digits; nobody sees what is below 1e-4."""
    return "< 0.0001" if error < 1e-4 else f"{error:.4f}" if error < 0.01 else f"{error:.3g}"


def format_build_time(seconds: float | None) -> str:
    """4.1 s; 'nothing' where there is nothing to build, '' where others did."""
    return "" if seconds is None else format_time(seconds * 1e9) if seconds else "nothing"


def _told(value: float, units: tuple[tuple[float, str], ...]) -> str:
    factor, unit = next((pair for pair in units if value >= pair[0] * 0.9995), units[-1])
    return f"{value / factor:.3g} {unit}"
