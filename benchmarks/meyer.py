"""Reproduction of the tables and figures of Meyer 1988."""

import operator
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from benchmarks import Row, read_reference
from uplift.colorimetry import delta_e_1976, lab
from uplift.common.arrays import Array
from uplift.extras.pages.figure import GREY, INK, colour_map, new_figure, style_axes
from uplift.extras.scene.quadrature import QuadratureRule
from uplift.extras.scene.wavelengths import meyer as paper
from uplift.extras.scene.wavelengths.sampling import RenderSetup, interp_curves

CHANNELS = ("A", "C1", "C2")
COLOURS = ("#20509a", "#d1495b", "#2e8b57", "#c98a1b", "#7fa3d9")
CORNERS = np.array([[0.5, np.sqrt(0.75)], [0.0, 0.0], [1.0, 0.0]])
"""Corners of figure 7, where the first, second and third channel have all wavelengths.
"""
Nodes = tuple[Array, Array]
"""Wavelengths (n,) and weights (n,)."""
NO_FIGURES = {"printed": None, "ours": None}
DIVISIONS = 10
"""Small triangles of figure 7 along a side."""


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
