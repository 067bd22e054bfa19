"""Tables and recommendations of ``uplift compare``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .console import make_table, say, show

if TYPE_CHECKING:
    from uplift.lab.comparison.compare import Comparison, Statistics
    from uplift.lab.comparison.filters import TunedFilter


def print_comparison(comparison: Comparison) -> None:
    """Print a ranked table for each set of lights."""
    from uplift.lab.comparison.compare import HEADINGS
    from uplift.viz.format import format_time

    tables = []
    for name, title in comparison.sets.items():
        numbers = (*HEADINGS, "floats", "of a light", "product")
        table = make_table(("representation",), numbers, title=f"ΔE00 under {title}")
        for row in comparison.of(name):
            cost = (f"{row.floats:.1f}", f"{row.light_floats:.1f}", format_time(row.ns.median))
            table.add_row(row.name, *_cells(row.statistics), *cost)
        tables.append(table)
    show(*tables)


def print_filters(tuned: tuple[TunedFilter, ...]) -> None:
    """Print the best filter of each kind."""
    from uplift.lab.comparison.compare import HEADINGS

    title = "point sampling after the best low-pass filter of each kind"
    table = make_table(("lights", "samples", "filter", "parameters"), HEADINGS, title=title)
    for one in sorted(tuned, key=lambda one: (one.lights, one.count, one.statistics.mean)):
        table.add_row(one.lights, str(one.count), one.kind, one.parameters, *_cells(one.statistics))
    say()
    show(table)


def print_advice(comparison: Comparison, target: float) -> None:
    """Print the cheapest sufficient representation for each set of lights."""
    from uplift.lab.comparison.compare import cheapest, most_accurate
    from uplift.viz.format import format_error, format_time

    for name, title in comparison.sets.items():
        row = cheapest(comparison, name, target)
        if row is None:
            best = most_accurate(comparison, name)
            text = f"none; the most accurate, {best.name}, has {format_error(best.statistics.q97_5)}"
        else:
            text = (
                f"{row.name} ({row.family}): 97.5 % below {format_error(row.statistics.q97_5)}, "
                f"{row.floats:.4g} floats per surface, {row.light_floats:.4g} per light, "
                f"{format_time(row.ns.median)} per product"
            )
        say(f"{title}: {text}")


def _cells(statistics: Statistics) -> list[str]:
    return [f"{value:.3f}" for value in statistics]
