"""Selection of wavelengths, and reproduction of Meyer 1988, for docs/scene.md and its
pictures.
"""

import operator
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np

import uplift
from benchmarks import ATLAS_FILES, DOCS, MACBETH, Row, read_reference, record
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

NO_FIGURES = {"printed": None, "ours": None}
DIVISIONS = 10
"""Small triangles of figure 7 along a side."""

# --- the paper ---


def printed_rules(table: str, key: str) -> dict[tuple[str, str], Nodes]:
    """Return the rules of a table of the paper, by channel and a column ``key``."""
    points = defaultdict(list)
    for row in read_reference(table):
        point = float(row["wavelength"]), float(row["weight"])
        points[row["channel"], row[key]].append(point)
    return {name: tuple(np.array(rule).T) for name, rule in points.items()}


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
        spd = interp_curves(rule.nodes, setup.wavelengths, setup.powers)
        powers = spd * rule.weights
        responses = powers @ setup.curves(rule.nodes).T
        white = powers.sum(axis=1, keepdims=True)
        channels.append(np.concatenate([responses, white], axis=1))
    xyz = np.stack(channels, axis=-1) @ np.linalg.inv(space).T  # (K, M + 1, 3)
    colours = [lab(materials, white) for *materials, white in xyz]
    return delta_e_1976(setup.lab, colours).mean()


def run_trials(setup: RenderSetup, space: Array) -> tuple[Array, Array]:
    """Evaluate all allocations of defined orders up to 10: numbers of wavelengths (T,
    3) and mean ΔE76 (T,).
    """
    counts = []
    errors = []
    for allocation in paper.allocations(setup, space):
        counts.append(list(map(len, allocation)))
        errors.append(mean_error(setup, space, allocation))
    return np.array(counts), np.array(errors)


def errors_by_total(counts: Array, errors: Array) -> dict[int, Array]:
    """Group the errors of allocations by their total number of wavelengths."""
    totals = counts.sum(axis=1)
    return {int(total): errors[totals == total] for total in np.unique(totals)}


def compared(expected: Array, ours: Array) -> Row:
    """Return printed and recomputed values, and their largest difference."""
    return {
        "printed": expected,
        "ours": ours,
        "difference": np.abs(expected - ours).max(),
    }


def compare_meyer(setup: RenderSetup, spaces: Mapping[str, Array]) -> Row:
    """Recompute the matrices, tables 1a and 1b, and table 2."""
    space = spaces["AC1C2"]
    expected = printed_rules("meyer1988_table1.csv", "order")
    rules = paper.quadrature_rules(space, setup.wavelengths, setup.cmfs)
    nodes = []
    defined = []
    ours = []
    printed = []
    for channel, orders in zip(CHANNELS, rules, strict=True):
        for order, rule in orders.items():
            row = {"channel": channel, "order": order}
            printed_rule = expected.get((channel, str(order)))
            nodes.append(row | compared_nodes(rule, printed_rule))
            if isinstance(rule, QuadratureRule):
                defined.append(row)
                ours.append(rule.weights)
                printed.append(printed_rule[1])
    # One factor takes the recomputed weights to the printed ones, by least squares.
    all_ours = np.concatenate(ours)
    factor = all_ours @ np.concatenate(printed) / (all_ours @ all_ours)
    differences = map(compared, printed, [factor * weights for weights in ours])
    return {
        "opponent": matrices(setup, spaces),
        "weight_factor": factor,
        "nodes": nodes,
        "weights": map(operator.or_, defined, differences),
        "four": four_wavelengths(setup, space, rules, factor),
    }


def matrices(setup: RenderSetup, spaces: Mapping[str, Array]) -> list[Row]:
    """Return each channel as a sum of X, Y and Z."""
    _, eigenvalues = paper.opponent_space(setup.wavelengths, setup.cmfs)
    rows = []
    for row in read_reference("meyer1988_matrices.csv"):
        name = row["space"]
        channels = CHANNELS if name == "AC1C2" else name
        index = channels.index(row["channel"])
        eigenvalue = NO_FIGURES
        if row["eigenvalue"]:
            printed = float(row["eigenvalue"])
            eigenvalue = {"printed": printed, "ours": eigenvalues[index]}
        printed = np.array([float(row[axis]) for axis in "XYZ"])
        matrix = compared(printed, spaces[name][index])
        rows.append({"channel": row["channel"], **matrix, "eigenvalue": eigenvalue})
    return rows


def compared_nodes(rule: QuadratureRule | str, expected: Nodes | None) -> Row:
    """Return the wavelengths of an order in tables 1a and 1b; ``undefined`` is why it
    has none.
    """
    if isinstance(rule, QuadratureRule):
        return {**compared(expected[0], rule.nodes), "undefined": None}
    return {
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
    table = "meyer1988_table2.csv"
    separate = tuple(map(operator.getitem, rules, (3, 2, 1)))
    functions = paper.channel_functions(space, setup.wavelengths, setup.cmfs)
    shared = paper.four_wavelength_rule(functions)
    expected = printed_rules(table, "row")
    stated = {row["row"]: row["error"] for row in read_reference(table) if row["error"]}
    for number, allocation in (("1", separate), ("2", shared)):
        row = number
        error = mean_error(setup, space, allocation)
        errors = {"printed": float(stated[number]), "ours": error}
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
            errors = NO_FIGURES


# --- methods ---

Errors = Mapping[tuple[str, int], Array]
"""By method and number of wavelengths."""


def compare_methods(materials: Array, lights: tuple[str, ...]) -> dict[str, Errors]:
    """Evaluate all methods with all numbers of wavelengths under several lights at
    once.

    ``unseen``: fitted to the even ones, tested on the odd ones; methods that are not
    fitted get the latter, which favours Meyer's allocation. ``all``: fitted to and
    tested on all.
    """
    setup = make_setup(materials, lights)
    odd = np.arange(len(materials)) % 2 == 1
    fitted = setup.only(~odd)
    tested = setup.only(odd)
    unseen = {}
    every = {}
    for count, method in product(COUNTS, METHODS):
        sampling = METHODS[method](tested if method in OTHERS else fitted, count)
        unseen[method, count] = evaluate(tested, sampling)
        every[method, count] = choose(setup, method=method, count=count).errors
    return {"unseen": unseen, "all": every}


def tables(
    lights: tuple[str, ...], comparison: Mapping[str, Errors]
) -> Iterator[tuple[Row, list[Row]]]:
    """Yield the summary of a test and its rows: [mean, 95th percentile, largest] ΔE00
    of every method.

    ``gain`` is the ratio of the best other method's mean to the optimised one's.
    ``needed`` are the fewest wavelengths for a mean of 1; None if 16 do not reach it.
    """
    for materials, errors in comparison.items():
        means = mean_errors(errors)
        gains = np.min([means[other] for other in OTHERS], axis=0) / means[OPTIMISED]
        head = {"lights": ", ".join(lights), "materials": materials}
        rows = []
        for count, gain in zip(COUNTS, gains, strict=True):
            values = {
                method: [*statistics(errors[method, count]).values()]
                for method in METHODS
            }
            rows.append({**head, "count": count, "errors": values, "gain": gain})
        needed = {}
        for method, values in means.items():
            reached = np.flatnonzero(values <= 1)
            needed[method] = COUNTS[reached[0]] if len(reached) else None
        summary = {
            **head,
            "other_gain": spread(gains),
            "fitted_gain": spread(means["fitted"] / means[OPTIMISED]),
            "needed": needed,
        }
        yield summary, rows


def mean_errors(errors: Errors) -> dict[str, Array]:
    """Return the mean errors over `COUNTS` by method."""
    means = {}
    for method in METHODS:
        means[method] = np.array([errors[method, count].mean() for count in COUNTS])
    return means


def spread(ratios: Array) -> Row:
    """Return the median, smallest and largest of ratios over `COUNTS`."""
    return {
        "median": np.median(ratios),
        "min": ratios.min(),
        "max": ratios.max(),
    }


# --- pictures ---


def figure_6(trials: Mapping[str, tuple[Array, Array]]) -> Any:
    """Plot the mean and the best of all allocations over the number of wavelengths."""
    figure = new_figure(7.2, 3.6)
    axes = figure.subplots()
    for (name, (counts, errors)), colour in zip(trials.items(), COLOURS, strict=False):
        by_total = errors_by_total(counts, errors)
        totals = list(by_total)
        means = list(map(np.mean, by_total.values()))
        best = list(map(np.min, by_total.values()))
        axes.plot(totals, means, "o-", color=colour, markersize=3, label=name)
        axes.plot(totals, best, ":", color=colour)
    axes.plot([], [], "o-", color=GREY, markersize=3, label="mean of all allocations")
    axes.plot([], [], ":", color=GREY, label="best allocation")
    axes.set_ylabel("mean ΔE76")
    axes.legend(frameon=False, ncols=2)
    style_counts(axes)
    return figure


def style_counts(axes: Any) -> None:
    """Style axes of errors over the number of wavelengths."""
    axes.set(xlabel="wavelengths", yscale="log")
    axes.yaxis.set_major_formatter("{x:g}")
    style_axes(axes)


def figure_7(counts: Array, errors: Array) -> Any:
    """Plot the mean error over the channels' shares as triangles, darker if larger."""
    from matplotlib.collections import PolyCollection

    # A trial on a line between small triangles belongs to one side of it, regardless of
    # rounding.
    floors = np.floor(DIVISIONS * counts / counts.sum(axis=1, keepdims=True) + 1e-9)
    on_corner = np.flatnonzero(floors.sum(axis=1) == DIVISIONS)
    floors[on_corner, floors[on_corner].argmax(axis=1)] -= 1
    cells, cell_of = np.unique(floors, axis=0, return_inverse=True)
    means = np.bincount(cell_of.ravel(), errors) / np.bincount(cell_of.ravel())
    is_upright = (cells.sum(axis=1) == DIVISIONS - 1)[:, None, None]
    offsets = np.where(is_upright, np.eye(3), 1 - np.eye(3))
    shares = (cells[:, None, :] + offsets) / DIVISIONS
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
        axes.annotate(
            f"all for {name}",
            corner,
            xytext=(0, offset),
            textcoords="offset points",
            ha="center",
            va=side,
            color=INK,
            fontsize=9,
        )
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
        means = mean_errors(comparison["unseen"])
        for (method, values), colour in zip(means.items(), COLOURS, strict=True):
            axes.plot(COUNTS, values, "o-", color=colour, markersize=3, label=method)
        axes.set_title(", ".join(lights), loc="left", fontsize=9, color=INK)
        style_counts(axes)
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
    materials = on_grid(uplift.read_atlas(*ATLAS_FILES), grid())
    comparisons = {lights: compare_methods(materials, lights) for lights in LIGHTS}
    summaries = []
    errors = []
    for lights, comparison in comparisons.items():
        for summary, rows in tables(lights, comparison):
            summaries.append(summary)
            errors += rows
    PICTURES.mkdir(exist_ok=True)
    with styled():
        write_png(figure_6(trials), PICTURES / "figure-6.png", force=True)
        write_png(figure_7(*trials["AC1C2"]), PICTURES / "figure-7.png", force=True)
        write_png(plot_methods(comparisons), PICTURES / "methods.png", force=True)
    record(
        "wavelengths",
        materials=len(materials),
        summary=summaries,
        errors=errors,
        **compare_meyer(checker, spaces),
    )
