"""Selection of wavelengths, and reproduction of Meyer 1988, for docs/scene.md and its
pictures.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain
from typing import Any

import numpy as np

import uplift
from benchmarks import ATLASES, DOCS, MACBETH, Row, read_reference, record
from uplift.atlas import on_grid
from uplift.colorimetry import delta_e_1976, lab
from uplift.common.arrays import Array
from uplift.extras.pages.figure import (
    GREY,
    INK,
    colour_map,
    new_figure,
    style_axes,
    styled,
    write_png,
)
from uplift.extras.scene.quadrature import QuadratureRule
from uplift.extras.scene.wavelengths import METHODS, choose, grid, make_setup
from uplift.extras.scene.wavelengths import meyer as paper
from uplift.extras.scene.wavelengths.sampling import (
    RenderSetup,
    evaluate,
    interp_curves,
    statistics,
)

SPACES = {"AC1C2": "opponent", "SML": "cones", "XYZ": "xyz"}
"""Names of the paper, and of `uplift.extras.scene.wavelengths.choose_orders`."""
CHANNELS = ("A", "C1", "C2")
OPTIMISED = "optimised"
FITTED = "fitted"
OTHERS = ("meyer", "uniform", "bins")
"""Methods that are not fitted to materials."""
COUNTS = range(4, 17)
LIGHTS = (("A", "B", "C", "D65"), ("FL2", "FL7", "FL11"))
"""Smooth ones, and spiky ones."""
COLOURS = ("#20509a", "#d1495b", "#2e8b57", "#c98a1b", "#7fa3d9")
CORNERS = np.array([[0.5, np.sqrt(0.75)], [0.0, 0.0], [1.0, 0.0]])
"""Corners of figure 7, where the first, second and third channel have all wavelengths.
"""
PICTURES = DOCS / "wavelengths"
Nodes = tuple[Array, Array]
"""Wavelengths (n,) and weights (n,)."""

# --- the paper ---


def printed_rules(table: str, key: str) -> dict[tuple[str, str], Nodes]:
    """Return the rules of a table of the paper, by channel and value of the column
    ``key``.
    """
    lines = read_reference(table)
    found = {}
    for name in dict.fromkeys((row["channel"], row[key]) for row in lines):
        own = [row for row in lines if (row["channel"], row[key]) == name]
        found[name] = tuple(
            np.array([float(row[part]) for row in own])
            for part in ("wavelength", "weight")
        )
    return found


def mean_error(
    setup: RenderSetup, space: Array, allocation: Sequence[QuadratureRule]
) -> float:
    """Mean ΔE76 of an allocation: a rule for each channel.

    The white of L*a*b* is the perfect reflector, sampled at the same wavelengths as the
    materials. The paper uses the light itself. So it comes close to the printed errors;
    sampled at all wavelengths it does not.
    """
    channels = []
    for rule in allocation:
        powers = (
            interp_curves(rule.nodes, setup.wavelengths, setup.powers) * rule.weights
        )
        channels.append(
            np.concatenate(
                [
                    powers @ setup.curves(rule.nodes).T,
                    powers.sum(axis=1, keepdims=True),
                ],
                axis=1,
            )
        )
    xyz = np.stack(channels, axis=-1) @ np.linalg.inv(space).T  # (K, M + 1, 3)
    return float(
        delta_e_1976(
            setup.lab, np.stack([lab(each[:-1], each[-1]) for each in xyz])
        ).mean()
    )


def run_trials(setup: RenderSetup, space: Array) -> tuple[Array, Array]:
    """Evaluate every allocation of defined orders up to 10: numbers of wavelengths (T,
    3) and mean ΔE76 (T,).
    """
    candidates = list(paper.allocations(setup, space))
    counts = [[len(rule) for rule in allocation] for allocation in candidates]
    return np.array(counts), np.array(
        [mean_error(setup, space, allocation) for allocation in candidates]
    )


def errors_by_total(counts: Array, errors: Array) -> dict[int, Array]:
    """Group the errors of allocations by their total number of wavelengths."""
    totals = counts.sum(axis=1)
    return {int(total): errors[totals == total] for total in np.unique(totals)}


def compared(expected: Array, ours: Array) -> Row:
    """Return printed and recomputed values, and their largest difference."""
    return {
        "printed": expected,
        "ours": ours,
        "difference": float(np.abs(expected - ours).max()),
    }


def compare_meyer(setup: RenderSetup, spaces: Mapping[str, Array]) -> Row:
    """Recompute the matrices, tables 1a and 1b, and table 2."""
    space = spaces["AC1C2"]
    expected = printed_rules("meyer1988_table1.csv", "order")
    rules = paper.quadrature_rules(space, setup.wavelengths, setup.cmfs)
    orders = [
        (key, order, rule)
        for key, each in zip(CHANNELS, rules, strict=True)
        for order, rule in each.items()
    ]
    defined = [
        (key, order, rule)
        for key, order, rule in orders
        if isinstance(rule, QuadratureRule)
    ]
    # One factor takes the recomputed weights to the printed ones, by least squares.
    ours = np.concatenate([rule.weights for *_, rule in defined])
    printed = np.concatenate(
        [expected[key, str(order)][1] for key, order, _ in defined]
    )
    factor = float(ours @ printed / (ours @ ours))
    weights = [
        {
            "channel": key,
            "order": order,
            **compared(expected[key, str(order)][1], factor * rule.weights),
        }
        for key, order, rule in defined
    ]
    return {
        "opponent": matrices(setup, spaces),
        "weight_factor": factor,
        "nodes": [
            node_row(key, order, rule, expected.get((key, str(order))))
            for key, order, rule in orders
        ],
        "weights": weights,
        "four": list(four_wavelengths(setup, space, rules, factor)),
    }


def matrices(setup: RenderSetup, spaces: Mapping[str, Array]) -> list[Row]:
    """Return each channel as a sum of X, Y and Z."""
    _, eigenvalues = paper.opponent_space(setup.wavelengths, setup.cmfs)
    rows = []
    for row in read_reference("meyer1988_matrices.csv"):
        index = (
            CHANNELS.index(row["channel"])
            if row["space"] == "AC1C2"
            else row["space"].index(row["channel"])
        )
        values = (
            (float(row["eigenvalue"]), float(eigenvalues[index]))
            if row["eigenvalue"]
            else (None, None)
        )
        eigenvalue = dict(zip(("printed", "ours"), values, strict=True))
        matrix = compared(
            np.array([float(row[axis]) for axis in "XYZ"]), spaces[row["space"]][index]
        )
        rows.append({"channel": row["channel"], **matrix, "eigenvalue": eigenvalue})
    return rows


def node_row(
    channel: str, order: int, rule: QuadratureRule | str, expected: Nodes | None
) -> Row:
    """Return the wavelengths of an order in tables 1a and 1b; ``undefined`` is why it
    has none.
    """
    row: Row = {"channel": channel, "order": order}
    if isinstance(rule, QuadratureRule):
        return row | compared(expected[0], rule.nodes) | {"undefined": None}
    return row | {
        "printed": expected and expected[0],
        "ours": None,
        "difference": None,
        "undefined": rule,
    }


def four_wavelengths(
    setup: RenderSetup,
    space: Array,
    rules: list[dict[int, QuadratureRule | str]],
    factor: float,
) -> Iterator[Row]:
    """Yield the rows of table 2; the first of each allocation has its error."""
    separate = tuple(
        orders[order] for orders, order in zip(rules, (3, 2, 1), strict=True)
    )
    shared = paper.four_wavelength_rule(
        paper.channel_functions(space, setup.wavelengths, setup.cmfs)
    )
    expected = printed_rules("meyer1988_table2.csv", "row")
    stated = {
        row["row"]: float(row["error"])
        for row in read_reference("meyer1988_table2.csv")
        if row["error"]
    }
    for number, allocation in (("1", separate), ("2", shared)):
        row = number
        errors = {
            "printed": stated[number],
            "ours": mean_error(setup, space, allocation),
        }
        for channel, rule in zip(CHANNELS, allocation, strict=True):
            wavelengths, weights = expected[channel, number]
            yield {
                "row": row,
                "channel": channel,
                "printed": {"wavelengths": wavelengths, "weights": weights},
                "ours": {"wavelengths": rule.nodes, "weights": factor * rule.weights},
                "delta_e": errors,
            }
            row = ""
            errors = {"printed": None, "ours": None}


# --- methods ---

Errors = Mapping[tuple[str, int], Array]
"""By method and number of wavelengths."""


def compare_methods(materials: Array, lights: tuple[str, ...]) -> dict[str, Errors]:
    """Evaluate all methods with every number of wavelengths under several lights at
    once, by materials of the test.

    ``unseen``: fitted to the even ones, tested on the odd ones; methods that are not
    fitted get the latter, which favours Meyer's allocation. ``all``: fitted to and
    tested on all.
    """
    setup = make_setup(materials, lights)
    odd = np.arange(len(materials)) % 2 == 1
    fitted = setup.only(~odd)
    tested = setup.only(odd)
    keys = [(method, count) for count in COUNTS for method in METHODS]

    def unseen(method: str, count: int) -> Array:
        return evaluate(
            tested, METHODS[method](tested if method in OTHERS else fitted, count)
        )

    every = {key: choose(setup, method=key[0], count=key[1]).errors for key in keys}
    return {"unseen": {key: unseen(*key) for key in keys}, "all": every}


def tables(
    lights: tuple[str, ...], comparison: Mapping[str, Errors]
) -> Iterator[tuple[Row, list[Row]]]:
    """Yield the summary of a test and its rows: [mean, 95th percentile, largest] ΔE00
    of every method.

    ``gain`` is the ratio of the best other method's mean to the optimised one's.
    ``needed`` are the fewest wavelengths for a mean of 1; None if 16 do not reach it.
    """
    for materials, errors in comparison.items():
        means = {
            method: np.array([errors[method, count].mean() for count in COUNTS])
            for method in METHODS
        }
        gains = np.min([means[other] for other in OTHERS], axis=0) / means[OPTIMISED]
        head = {"lights": ", ".join(lights), "materials": materials}
        rows = []
        for count, gain in zip(COUNTS, gains.tolist(), strict=True):
            cells = {method: errors[method, count] for method in METHODS}
            values = {
                name: list(statistics(one).values()) for name, one in cells.items()
            }
            rows.append({**head, "count": count, "errors": values, "gain": gain})
        fewest = {
            method: next((n for n in COUNTS if errors[method, n].mean() <= 1), None)
            for method in METHODS
        }
        ratios = {"other_gain": gains, "fitted_gain": means[FITTED] / means[OPTIMISED]}
        yield (
            {
                **head,
                **{name: spread(values) for name, values in ratios.items()},
                "needed": fewest,
            },
            rows,
        )


def spread(ratios: Array) -> Row:
    """Return the median, smallest and largest of ratios over `COUNTS`."""
    return {
        "median": float(np.median(ratios)),
        "min": float(ratios.min()),
        "max": float(ratios.max()),
    }


# --- pictures ---


def figure_6(trials: Mapping[str, tuple[Array, Array]]) -> Any:
    """Plot the mean over all allocations, and the best of them, over the number of
    wavelengths.
    """
    figure = new_figure(7.2, 3.6)
    axes = figure.subplots()
    for (name, (counts, errors)), colour in zip(trials.items(), COLOURS, strict=False):
        by_total = errors_by_total(counts, errors)
        means, best = (
            [reduce(each) for each in by_total.values()] for reduce in (np.mean, np.min)
        )
        axes.plot(list(by_total), means, "o-", color=colour, markersize=3, label=name)
        axes.plot(list(by_total), best, ":", color=colour)
    axes.plot([], [], "o-", color=GREY, markersize=3, label="mean of all allocations")
    axes.plot([], [], ":", color=GREY, label="best allocation")
    axes.set(xlabel="wavelengths", ylabel="mean ΔE76", yscale="log")
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.legend(frameon=False, ncols=2)
    style_axes(axes)
    return figure


def figure_7(counts: Array, errors: Array, divisions: int = 10) -> Any:
    """Plot the mean error over the shares of the channels as small triangles, darker
    for larger errors.
    """
    from matplotlib.collections import PolyCollection

    # A trial on a line between small triangles belongs to one side of it, regardless of
    # rounding.
    floors = np.floor(
        divisions * counts / counts.sum(axis=1, keepdims=True) + 1e-9
    ).astype(int)
    floors -= (floors.sum(axis=1) == divisions)[:, None] * np.eye(3, dtype=int)[
        floors.argmax(axis=1)
    ]
    cells, cell_of = np.unique(floors, axis=0, return_inverse=True)
    means = np.bincount(cell_of.ravel(), errors) / np.bincount(cell_of.ravel())
    upright = (cells.sum(axis=1) == divisions - 1)[:, None, None]
    shares = (
        cells[:, None, :] + np.where(upright, np.eye(3), 1 - np.eye(3))
    ) / divisions
    figure = new_figure(6.0, 4.6)
    axes = figure.subplots()
    style = {"cmap": colour_map(), "edgecolors": "white", "linewidths": 0.6}
    triangles = axes.add_collection(
        PolyCollection(shares @ CORNERS, array=means, **style)
    )
    axes.plot(*CORNERS[[0, 1, 2, 0]].T, color=GREY, linewidth=0.8)
    for name, corner, side, offset in zip(
        CHANNELS, CORNERS, ("bottom", "top", "top"), (5, -5, -5), strict=True
    ):
        place = {
            "xytext": (0, offset),
            "textcoords": "offset points",
            "ha": "center",
            "va": side,
        }
        axes.annotate(f"all for {name}", corner, color=INK, fontsize=9, **place)
    axes.set_aspect("equal")
    axes.set(xlim=(-0.12, 1.12), ylim=(-0.1, 0.97))
    axes.set_axis_off()
    figure.colorbar(triangles, ax=axes, shrink=0.8, label="mean ΔE76")
    return figure


def plot_methods(comparisons: Mapping[tuple[str, ...], Mapping[str, Errors]]) -> Any:
    """Plot mean ΔE00 on held-out materials over the number of wavelengths."""
    figure = new_figure(7.2, 3.4)
    panels = figure.subplots(1, len(comparisons), sharey=True)
    for axes, (lights, comparison) in zip(panels, comparisons.items(), strict=True):
        for method, colour in zip(METHODS, COLOURS, strict=True):
            means = [comparison["unseen"][method, count].mean() for count in COUNTS]
            axes.plot(COUNTS, means, "o-", color=colour, markersize=3, label=method)
        axes.set(xlabel="wavelengths", yscale="log")
        axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
        axes.set_title(", ".join(lights), loc="left", fontsize=9, color=INK)
        style_axes(axes)
    panels[0].set_ylabel("mean ΔE00, unseen materials")
    figure.legend(
        *panels[0].get_legend_handles_labels(),
        loc="outside upper center",
        ncols=5,
        frameon=False,
    )
    return figure


def main() -> None:
    """Measure, draw and store."""
    checker = make_setup(on_grid(uplift.read_atlas(MACBETH), grid()), ["C"])
    spaces = {
        name: paper.SPACES[key](checker.wavelengths, checker.cmfs)
        for name, key in SPACES.items()
    }
    trials = {name: run_trials(checker, space) for name, space in spaces.items()}
    materials = on_grid(uplift.read_atlas(*sorted(ATLASES.glob("*.txt"))), grid())
    comparisons = {lights: compare_methods(materials, lights) for lights in LIGHTS}
    found = list(
        chain.from_iterable(
            tables(lights, comparison) for lights, comparison in comparisons.items()
        )
    )
    PICTURES.mkdir(exist_ok=True)
    with styled():
        write_png(figure_6(trials), PICTURES / "figure-6.png", force=True)
        write_png(figure_7(*trials["AC1C2"]), PICTURES / "figure-7.png", force=True)
        write_png(plot_methods(comparisons), PICTURES / "methods.png", force=True)
    record(
        "wavelengths",
        materials=len(materials),
        summary=[summary for summary, _ in found],
        errors=list(chain.from_iterable(rows for _, rows in found)),
        **compare_meyer(checker, spaces),
    )
