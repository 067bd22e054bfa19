"""Spectral representations compared with Kment 2011, for docs/scene.md and its
pictures.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, product
from typing import Any

import numpy as np

import uplift
from benchmarks import ATLASES, DOCS, Row, read_reference, record
from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.extras.scene.representations import all_representations, samples
from uplift.extras.scene.representations.composite import (
    ENHANCED_THRESHOLD,
    composite,
    enhanced_riemann,
)
from uplift.extras.scene.representations.samples import Representation, linear
from uplift.lab.comparison import compare
from uplift.lab.comparison.compare import Comparison, Scene, TunedFilter
from uplift.lab.comparison.pictures import write_boxes, write_costs

OTHER_LIGHTS = ("LED-B3", "LED-RGB1", "HP1")
TARGETS = (2.0, 1.0, 0.5)
TABLE = 81
"""Floats of a light that is kept as its 5 nm table."""
RIEMANN_COUNTS = (8, 16, 32)


@dataclass(frozen=True)
class Printed:
    """Printed errors of a representation, or of a filter with its ``parameters``."""

    mean: float
    q97_5: float | None = None
    parameters: str = ""


def main() -> None:
    """Measure, draw and store."""
    atlases = {
        path.stem: uplift.read_atlas(path) for path in sorted(ATLASES.glob("*.txt"))
    }
    default = compare.make_scene(atlases)
    ours, others = (
        _compare(scene)
        for scene in (default, compare.make_scene(atlases, OTHER_LIGHTS))
    )
    write_boxes(ours, DOCS / "representations" / "boxes.png", force=True)
    write_costs(ours, DOCS / "representations" / "cost.png", force=True)
    record(
        "representations",
        surfaces=len(default.surfaces),
        advice=list(chain.from_iterable(advice(one) for one in (ours, others))),
        ranking=[*ranking(ours, printed_tables()), *ranking(others, {})],
        riemann=riemann_rows(default, printed_tables()),
        filters=filter_rows(compare.tune_filters(default), printed_filters()),
    )


def _compare(scene: Scene) -> Comparison:
    return compare.compare(scene, all_representations(scene.powers, scene.surfaces))


def printed_tables() -> dict[tuple[str, str], Printed]:
    """Return tables 6.1 and 6.2 of the thesis, by lights and representation."""
    rows = read_reference("representations_kment2011.csv")
    return {
        (row["lights"], row["representation"]): Printed(
            float(row["mean"]), float(row["q97_5"])
        )
        for row in rows
    }


def printed_filters() -> dict[tuple[str, int, str], Printed]:
    """Return tables A.1 and A.2 of the thesis, by lights, samples and kind
    of filter.
    """
    return {
        (row["lights"], int(row["samples"]), row["filter"]): Printed(
            float(row["mean"]), parameters=row["parameters"].replace(";", ",")
        )
        for row in read_reference("filters_kment2011.csv")
    }


def advice(comparison: Comparison) -> Iterator[Row]:
    """Yield the cheapest representation for each set of lights and target, with and
    without tables of lights.
    """
    without = tuple(row for row in comparison.results if row.light_floats < TABLE)
    kinds = {
        "cheapest": comparison,
        "without_light_table": replace(comparison, results=without),
    }
    for (name, title), target in product(comparison.sets.items(), TARGETS):
        best = {
            key: compare.cheapest(each, name, target) for key, each in kinds.items()
        }
        named = {
            key: row
            and {
                "name": row.name,
                "floats": row.floats,
                "light_floats": row.light_floats,
            }
            for key, row in best.items()
        }
        yield {"lights": title, "target": target, **named}


def ranking(
    comparison: Comparison, thesis: Mapping[tuple[str, str], Printed]
) -> Iterator[Row]:
    """Yield the errors and costs of every representation under each set of lights,
    smallest mean first.
    """
    names = ("mean", "std", "median", "p2_5", "p25", "p75", "p97_5")
    for row in comparison.results:
        printed = thesis.get((row.lights, row.name))
        yield {
            "lights": row.lights,
            "name": row.name,
            **dict(zip(names, row.statistics, strict=True)),
            "thesis_mean": printed.mean if printed else None,
            "thesis_p97_5": printed.q97_5 if printed else None,
            "floats": row.floats,
            "light_floats": row.light_floats,
            "time": row.ns.median,
        }


def filter_rows(
    tuned: Sequence[TunedFilter], thesis: Mapping[tuple[str, int, str], Printed]
) -> list[Row]:
    """Return the best filter of each kind; ``change`` is relative to no filter, None
    for that row.
    """
    unfiltered = {
        (one.lights, one.count): one.statistics.mean
        for one in tuned
        if one.kind == compare.NONE
    }
    rows = []
    for one in tuned:
        printed = thesis[one.lights, one.count, one.kind]
        bare = thesis[one.lights, one.count, compare.NONE]
        mean = one.statistics.mean
        changes = (
            mean / unfiltered[one.lights, one.count] - 1,
            printed.mean / bare.mean - 1,
        )
        ours, theirs = (None, None) if one.kind == compare.NONE else changes
        rows.append(
            {
                "lights": one.lights,
                "samples": one.count,
                "filter": one.kind,
                "mean": mean,
                "std": one.statistics.deviation,
                "change": ours,
                "parameters": one.parameters,
                "thesis": {
                    "mean": printed.mean,
                    "change": theirs,
                    "parameters": printed.parameters,
                },
            }
        )
    return sorted(rows, key=lambda row: (row["lights"], row["samples"], row["mean"]))


def riemann_rows(scene: Scene, thesis: Mapping[tuple[str, str], Printed]) -> list[Row]:
    """Return mean ΔE00 of plain and enhanced sums with disjoint and with closed cells,
    and of the thesis.

    Closed cells are the literal reading of eq. 5.3: samples on a border count twice.
    """
    pairs: list[tuple[Any, Any]] = [
        (samples.riemann_sums(count), closed(count)) for count in RIEMANN_COUNTS
    ]
    pairs += [(enhanced_riemann(count), enhanced(count)) for count in RIEMANN_COUNTS]
    return [
        {
            "lights": lights.name,
            "name": one.name,
            "disjoint": compare.error_statistics(one, lights).mean,
            "closed": compare.error_statistics(other, lights).mean,
            "thesis": thesis[lights.name, one.name].mean,
        }
        for lights in scene.sets
        for one, other in pairs
    ]


def closed(count: int) -> Representation:
    """Return means over closed cells; XYZ by the colour-matching functions at 5 nm,
    shared between cells.
    """
    inside = _cells(count)
    encoder = np.zeros((len(samples.wavelengths()), count))
    encoder[:: samples.TABLE_STRIDE] = (inside / inside.sum(axis=1, keepdims=True)).T
    weights = (inside / inside.sum(axis=0)) @ (
        samples.xyz_weights()[:: samples.TABLE_STRIDE] * samples.TABLE_STRIDE
    )
    return linear(f"RS{count}", "Riemann sums, closed cells", encoder, weights)


def enhanced(count: int) -> Representation:
    """Return enhanced sums over the same cells; a spike on a border is multiplied by
    the mean of both.
    """
    inside = _cells(count)
    family = "enhanced Riemann sums, closed cells"
    return composite(
        f"RE{count}",
        family,
        closed(count),
        inside / inside.sum(axis=0),
        ENHANCED_THRESHOLD,
    )


def _cells(count: int) -> Array:
    """Return (count, 81) whether a sample of the 5 nm table lies in a cell."""
    edges = np.linspace(observer.START, observer.END, count + 1)
    low = edges[:-1, None] - 1e-9
    high = edges[1:, None] + 1e-9
    return ((observer.grid() >= low) & (observer.grid() <= high)).astype(float)
