"""Spectral representations compared with Kment 2011, for docs/scene.md,
docs/reproductions.md and their pictures.
"""

from collections.abc import Iterable
from functools import cache

import numpy as np

from benchmarks import DOCS, Row, with_printed
from benchmarks.materials import read_atlases
from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.extras.papers.representations import samples
from uplift.extras.papers.representations.compare import (
    Comparison,
    Scene,
    compare,
    make_scene,
)
from uplift.extras.papers.representations.composite import ENHANCED_THRESHOLD, composite
from uplift.extras.papers.representations.pictures import write_boxes, write_costs
from uplift.extras.papers.representations.registry import all_representations
from uplift.extras.papers.representations.samples import Representation, linear
from uplift.extras.papers.representations.tuning import tune_filters
from uplift.extras.scene.passes.representation import pass_representations

OTHER_LIGHTS = ("LED-B3", "LED-RGB1", "HP1")
RIEMANN_COUNTS = (8, 16, 32)
FOLDER = DOCS / "representations"


@cache
def scene() -> Scene:
    """Return all atlases under the lights of the thesis."""
    return make_scene(read_atlases())


def errors() -> list[Row]:
    """Compare representations under the lights of the thesis and under others, and draw
    the former.
    """
    ours = compare_all(scene())
    write_boxes(ours, FOLDER / "boxes.png", force=True)
    write_costs(ours, FOLDER / "cost.png", force=True)
    others = compare_all(make_scene(read_atlases(), OTHER_LIGHTS))
    return with_tables_6([*ours.rows, *others.rows])


def closed_cells() -> list[Row]:
    """Compare Riemann sums over closed cells under the lights of the thesis."""
    sums = [*map(closed, RIEMANN_COUNTS), *map(enhanced, RIEMANN_COUNTS)]
    return with_tables_6(compare(scene(), sums).rows)


def with_tables_6(rows: Iterable[Row]) -> list[Row]:
    """Add the figures of tables 6.1 and 6.2."""
    table = "representations_kment2011.csv"
    keys = ("lights", "representation")
    return with_printed(rows, table, keys, mean=float, q97_5=float)


def compare_all(scene: Scene) -> Comparison:
    """Compare all representations."""
    registered = all_representations(scene.powers, scene.surfaces)
    return compare(scene, [*registered, *pass_representations()])


def filters() -> list[Row]:
    """Search the best filter of each kind."""
    table = "filters_kment2011.csv"
    keys = ("lights", "samples", "filter")
    rows = tune_filters(scene())
    return with_printed(rows, table, keys, mean=float, parameters=str)


def closed(count: int) -> Representation:
    """Return means over closed cells, the literal reading of eq. 5.3, in which samples
    on a border count twice; XYZ by functions at 5 nm shared between cells.
    """
    inside = cells(count)
    encoder = np.zeros((len(samples.wavelengths()), count))
    encoder[:: samples.TABLE_STRIDE] = (inside / inside.sum(axis=1, keepdims=True)).T
    at_5_nm = samples.xyz_weights()[:: samples.TABLE_STRIDE] * samples.TABLE_STRIDE
    weights = (inside / inside.sum(axis=0)) @ at_5_nm
    return linear(f"RS{count}", "Riemann sums, closed cells", encoder, weights)


def enhanced(count: int) -> Representation:
    """Return enhanced sums over the same cells; a spike on a border counts in both."""
    inside = cells(count)
    family = "enhanced Riemann sums, closed cells"
    shares = inside / inside.sum(axis=0)
    name = f"RE{count}"
    return composite(name, family, closed(count), shares, ENHANCED_THRESHOLD)


def cells(count: int) -> Array:
    """Return (count, 81) whether a sample of the 5 nm table lies in a cell."""
    edges = np.linspace(observer.START, observer.END, count + 1)
    low = edges[:-1, None] - 1e-9
    high = edges[1:, None] + 1e-9
    return ((observer.grid() >= low) & (observer.grid() <= high)).astype(float)


QUESTIONS = {"errors": errors, "closed_cells": closed_cells, "filters": filters}
