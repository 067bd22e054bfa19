"""Reproduction of the tables and figures of Meyer 1988, for docs/reproductions.md."""

from collections.abc import Iterable, Sequence
from itertools import chain
from typing import Any

import numpy as np

import uplift
from benchmarks import DOCS, MACBETH, Row, read_reference
from uplift.atlas import on_grid
from uplift.colorimetry import delta_e_1976, lab
from uplift.common.arrays import Array
from uplift.extras.pages.figure import GREY, INK, colour_map, write_figure
from uplift.extras.pages.marks import Mark, line
from uplift.extras.pages.panels import Axis, Panel, draw
from uplift.extras.scene.quadrature import QuadratureRule
from uplift.extras.scene.wavelengths import grid, make_setup
from uplift.extras.scene.wavelengths import meyer as paper
from uplift.extras.scene.wavelengths.sampling import RenderSetup, interp_curves

COLOURS = {"opponent": "#20509a", "cones": "#d1495b", "xyz": "#2e8b57"}
"""Colours of the spaces AC1C2, SML and XYZ of the paper."""
CHANNELS = ("A", "C1", "C2")
CORNERS = np.array([[0.5, np.sqrt(0.75)], [0.0, 0.0], [1.0, 0.0]])
"""Corners of figure 7, where the first, second and third channel have all wavelengths.
"""
PICTURES = DOCS / "wavelengths"
CELLS = 10
"""Cells of figure 7 along a side."""
Allocation = Sequence[QuadratureRule]
"""A rule for each channel."""


def checker() -> RenderSetup:
    """Return the materials and the light of the paper."""
    return make_setup(on_grid(uplift.read_atlas(MACBETH), grid()), ["C"])


def matrix(setup: RenderSetup, space: str) -> Array:
    """Return the matrix from XYZ to the channels of a space."""
    return paper.SPACES[space](setup.wavelengths, setup.cmfs)


def mean_error(setup: RenderSetup, space: Array, allocation: Allocation) -> float:
    """Mean ΔE76 of an allocation.

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


def compared(
    table: str, key: str, printed: Iterable[Row], **ours: Iterable[float]
) -> list[Row]:
    """Return each value of columns of a printed table, whose rows ``key`` divides into
    sets, and ours.
    """
    rows = []
    for quantity, values in ours.items():
        for row, value in zip(printed, values, strict=True):
            rows.append(
                {
                    "table": table,
                    "set": row[key],
                    "channel": row["channel"],
                    "quantity": quantity,
                    "printed": float(row[quantity]),
                    "ours": value,
                }
            )
    return rows


def matrix_values(setup: RenderSetup) -> list[Row]:
    """Return the elements of both matrices, and the eigenvalues."""
    printed = read_reference("meyer1988_matrices.csv")
    elements = np.concatenate([matrix(setup, "cones"), matrix(setup, "opponent")])
    _, eigenvalues = paper.opponent_space(setup.wavelengths, setup.cmfs)
    by_axis = dict(zip("XYZ", elements.T, strict=True))
    return [
        *compared("matrices", "space", printed, **by_axis),
        *compared("eigenvalues", "space", printed[3:], eigenvalue=eigenvalues),
    ]


def rule_values(setup: RenderSetup) -> list[Row]:
    """Return the wavelengths and weights of tables 1 and 2, and the errors of the
    latter.

    One factor takes the recomputed weights to the printed ones, by least squares.
    """
    space = matrix(setup, "opponent")
    rules = paper.quadrature_rules(space, setup.wavelengths, setup.cmfs)
    orders = chain.from_iterable(of_channel.values() for of_channel in rules)
    defined = [rule for rule in orders if isinstance(rule, QuadratureRule)]
    functions = paper.channel_functions(space, setup.wavelengths, setup.cmfs)
    separate = [rules[0][3], rules[1][2], rules[2][1]]
    shared = paper.four_wavelength_rule(functions)
    errors = [mean_error(setup, space, each) for each in (separate, shared)]
    first = read_reference("meyer1988_table1.csv")
    second = read_reference("meyer1988_table2.csv")
    expected = [float(row["weight"]) for row in first]
    weights = columns(defined)["weight"]
    factor = weights @ expected / (weights @ weights)
    four = [*separate, *shared]
    with_error = {row["row"]: row for row in second}.values()
    return [
        *compared("1", "order", first, **columns(defined, factor)),
        *compared("2", "row", second, **columns(four, factor)),
        *compared("2", "row", with_error, error=errors),
    ]


def columns(rules: Allocation, factor: float = 1.0) -> dict[str, Array]:
    """Return the wavelengths and the scaled weights of rules."""
    return {
        "wavelength": np.concatenate([rule.nodes for rule in rules]),
        "weight": factor * np.concatenate([rule.weights for rule in rules]),
    }


def tables() -> list[Row]:
    """Return every printed value, and ours."""
    setup = checker()
    return [*matrix_values(setup), *rule_values(setup)]


def trials(setup: RenderSetup, space: Array) -> tuple[Array, Array]:
    """Evaluate all allocations of defined orders up to 10: numbers of wavelengths (T,
    3) and mean ΔE76 (T,).
    """
    allocations = list(paper.allocations(setup, space))
    counts = [list(map(len, allocation)) for allocation in allocations]
    errors = [mean_error(setup, space, allocation) for allocation in allocations]
    return np.array(counts), np.array(errors)


def by_total(counts: Array, errors: Array) -> dict[int, Array]:
    """Group the errors of allocations by their total number of wavelengths."""
    totals = counts.sum(axis=1)
    return {int(total): errors[totals == total] for total in np.unique(totals)}


def figures() -> None:
    """Draw figure 6, mean and smallest errors of all allocations, and figure 7."""
    setup = checker()
    lines = []
    for space, colour in COLOURS.items():
        counts, errors = trials(setup, matrix(setup, space))
        if space == "opponent":
            figure = draw([Panel([cells(counts, errors)])], size=(5.0, 3.8))
            write_figure(figure, PICTURES / "figure-7.png", force=True)
        found = by_total(counts, errors)
        means = list(map(np.mean, found.values()))
        least = list(map(np.min, found.values()))
        lines.append(line(list(found), means, space, colour, marker="o", markersize=3))
        lines.append(line(list(found), least, colour=colour, linestyle=":"))
    panel = Panel(lines, "", Axis("wavelengths"), Axis("mean ΔE76", log=True))
    figure = draw([panel], size=(7.2, 3.6), legend="above")
    write_figure(figure, PICTURES / "figure-6.png", force=True)


def cells(counts: Array, errors: Array) -> Mark:
    """Draw the mean error of trials in cells over the shares of the channels."""
    shares = counts / counts.sum(axis=1, keepdims=True)

    def mark(axes: Any) -> None:
        style = {"cmap": colour_map(), "edgecolors": "white", "gridsize": CELLS}
        drawn = axes.hexbin(*(shares @ CORNERS).T, C=errors, **style)
        axes.plot(*CORNERS[[0, 1, 2, 0]].T, color=GREY, linewidth=0.8)
        for name, (x, y) in zip(CHANNELS, CORNERS, strict=True):
            side = "bottom" if y else "top"
            axes.text(x, y, f"all for {name}", ha="center", va=side, color=INK)
        axes.set_aspect("equal")
        axes.set_axis_off()
        axes.figure.colorbar(drawn, ax=axes, shrink=0.8, label="mean ΔE76")

    return mark


QUESTIONS = {"tables": tables, "figures": figures}
