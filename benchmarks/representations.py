"""Spectral representations compared with Kment 2011, for docs/scene.md and its
pictures.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from operator import itemgetter

import numpy as np

from benchmarks import DOCS, Row, read_reference, record
from benchmarks.materials import read_atlases
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
from uplift.lab.comparison.compare import Comparison, Scene
from uplift.lab.comparison.pictures import write_boxes, write_costs
from uplift.lab.comparison.tuning import NONE, TunedFilter, tune_filters

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
    atlases = read_atlases()
    default = compare.make_scene(atlases)
    ours = _compare(default)
    others = _compare(compare.make_scene(atlases, OTHER_LIGHTS))
    printed = printed_tables()
    write_boxes(ours, DOCS / "representations" / "boxes.png", force=True)
    write_costs(ours, DOCS / "representations" / "cost.png", force=True)
    record(
        "representations",
        surfaces=len(default.surfaces),
        advice=[*advice(ours), *advice(others)],
        ranking=[*ranking(ours, printed), *ranking(others, {})],
        riemann=riemann_rows(default, printed),
        filters=filter_rows(tune_filters(default), printed_filters()),
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
    """Return tables A.1 and A.2 of the thesis, by lights, samples and filter."""
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
    no_tables = replace(comparison, results=without)

    def cheapest(among: Comparison, name: str, target: float) -> Row | None:
        row = compare.cheapest(among, name, target)
        return row and {
            "name": row.name,
            "floats": row.floats,
            "light_floats": row.light_floats,
        }

    for (name, title), target in product(comparison.sets.items(), TARGETS):
        yield {
            "lights": title,
            "target": target,
            "cheapest": cheapest(comparison, name, target),
            "without_light_table": cheapest(no_tables, name, target),
        }


def ranking(
    comparison: Comparison, thesis: Mapping[tuple[str, str], Printed]
) -> Iterator[Row]:
    """Yield the errors and costs of all representations by lights, smallest mean
    first.
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
    means = {
        (best.lights, best.count, best.kind): best.statistics.mean for best in tuned
    }
    rows = []
    for best in tuned:
        key = best.lights, best.count, best.kind
        lights, count, kind = key
        bare = lights, count, NONE
        is_filtered = kind != NONE
        printed = thesis[key]
        rows.append(
            {
                "lights": lights,
                "samples": count,
                "filter": kind,
                "mean": means[key],
                "std": best.statistics.deviation,
                "change": means[key] / means[bare] - 1 if is_filtered else None,
                "parameters": best.parameters,
                "thesis": {
                    "mean": printed.mean,
                    "change": printed.mean / thesis[bare].mean - 1
                    if is_filtered
                    else None,
                    "parameters": printed.parameters,
                },
            }
        )
    return sorted(rows, key=itemgetter("lights", "samples", "mean"))


def riemann_rows(scene: Scene, thesis: Mapping[tuple[str, str], Printed]) -> list[Row]:
    """Return mean ΔE00 of plain and enhanced sums with disjoint and with closed cells,
    and of the thesis.

    Closed cells are the literal reading of eq. 5.3: samples on a border count twice.
    """
    kinds = ((samples.riemann_sums, closed), (enhanced_riemann, enhanced))
    rows = []
    for lights, (disjoint, overlapping), count in product(
        scene.sets, kinds, RIEMANN_COUNTS
    ):
        sums = disjoint(count)
        rows.append(
            {
                "lights": lights.name,
                "name": sums.name,
                "disjoint": compare.error_statistics(sums, lights).mean,
                "closed": compare.error_statistics(overlapping(count), lights).mean,
                "thesis": thesis[lights.name, sums.name].mean,
            }
        )
    return rows


def closed(count: int) -> Representation:
    """Return means over closed cells; XYZ by functions at 5 nm shared between cells."""
    inside = _cells(count)
    encoder = np.zeros((len(samples.wavelengths()), count))
    encoder[:: samples.TABLE_STRIDE] = (inside / inside.sum(axis=1, keepdims=True)).T
    at_5_nm = samples.xyz_weights()[:: samples.TABLE_STRIDE] * samples.TABLE_STRIDE
    weights = (inside / inside.sum(axis=0)) @ at_5_nm
    return linear(f"RS{count}", "Riemann sums, closed cells", encoder, weights)


def enhanced(count: int) -> Representation:
    """Return enhanced sums over the same cells; a spike on a border counts in both."""
    inside = _cells(count)
    return composite(
        f"RE{count}",
        "enhanced Riemann sums, closed cells",
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
