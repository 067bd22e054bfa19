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
from uplift.extras.pages.figure import (
    GREY,
    INK,
    colour_map,
    new_figure,
    styled,
    write_png,
)
from uplift.extras.scene.quadrature import QuadratureRule
from uplift.extras.scene.wavelengths import grid, make_setup
from uplift.extras.scene.wavelengths import meyer as paper
from uplift.extras.scene.wavelengths.sampling import RenderSetup, interp_curves

SPACES = {"AC1C2": "opponent", "SML": "cones", "XYZ": "xyz"}
"""Names of the paper, and of `uplift.extras.scene.wavelengths.choose_orders`."""
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
    """Return the matrix from XYZ to the channels of a space of the paper."""
    return paper.SPACES[SPACES[space]](setup.wavelengths, setup.cmfs)


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
            head = {"table": table, "set": row[key], "channel": row["channel"]}
            number = {"printed": float(row[quantity]), "ours": value}
            rows.append({**head, "quantity": quantity, **number})
    return rows


def matrix_values(setup: RenderSetup) -> list[Row]:
    """Return the elements of both matrices, and the eigenvalues."""
    printed = read_reference("meyer1988_matrices.csv")
    elements = np.concatenate([matrix(setup, "SML"), matrix(setup, "AC1C2")])
    _, eigenvalues = paper.opponent_space(setup.wavelengths, setup.cmfs)
    columns = dict(zip("XYZ", elements.T, strict=True))
    return [
        *compared("matrices", "space", printed, **columns),
        *compared("matrices", "space", printed[3:], eigenvalue=eigenvalues),
    ]


def rule_values(setup: RenderSetup) -> list[Row]:
    """Return the wavelengths and weights of tables 1 and 2, and the errors of the
    latter.

    One factor takes the recomputed weights to the printed ones, by least squares.
    """
    space = matrix(setup, "AC1C2")
    rules = paper.quadrature_rules(space, setup.wavelengths, setup.cmfs)
    orders = chain.from_iterable(of_channel.values() for of_channel in rules)
    defined = [rule for rule in orders if isinstance(rule, QuadratureRule)]
    first = read_reference("meyer1988_table1.csv")
    nodes, weights = joined(defined)
    expected = [float(row["weight"]) for row in first]
    factor = weights @ expected / (weights @ weights)
    functions = paper.channel_functions(space, setup.wavelengths, setup.cmfs)
    separate = [rules[0][3], rules[1][2], rules[2][1]]
    shared = paper.four_wavelength_rule(functions)
    second = read_reference("meyer1988_table2.csv")
    four, of_four = joined([*separate, *shared])
    errors = [mean_error(setup, space, each) for each in (separate, shared)]
    stated = {row["row"]: row for row in second}
    return [
        *compared("1", "order", first, wavelength=nodes, weight=factor * weights),
        *compared("2", "row", second, wavelength=four, weight=factor * of_four),
        *compared("2", "row", stated.values(), error=errors),
    ]


def joined(rules: Allocation) -> tuple[Array, Array]:
    """Return the wavelengths and the weights of rules."""
    nodes = np.concatenate([rule.nodes for rule in rules])
    return nodes, np.concatenate([rule.weights for rule in rules])


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


def figures() -> None:
    """Draw figure 6, errors over the number of wavelengths, and figure 7, errors over
    the shares of the channels.
    """
    setup = checker()
    found = {space: trials(setup, matrix(setup, space)) for space in SPACES}
    with styled():
        write_png(figure_6(found), PICTURES / "figure-6.png", force=True)
        write_png(figure_7(*found["AC1C2"]), PICTURES / "figure-7.png", force=True)


def figure_7(counts: Array, errors: Array) -> Any:
    """Plot the mean error over the channels' shares."""
    shares = counts / counts.sum(axis=1, keepdims=True)
    figure = new_figure(6.0, 4.6)
    axes = figure.subplots()
    axes.plot(*CORNERS[[0, 1, 2, 0]].T, color=GREY, linewidth=0.8)
    points = (shares @ CORNERS).T
    style = {"cmap": colour_map(), "edgecolors": "white", "gridsize": CELLS}
    cells = axes.hexbin(*points, C=errors, **style)
    for name, (x, y) in zip(CHANNELS, CORNERS, strict=True):
        side = "bottom" if y else "top"
        axes.text(x, y, f"all for {name}", ha="center", va=side, color=INK)
    axes.set_aspect("equal")
    axes.set_axis_off()
    figure.colorbar(cells, ax=axes, shrink=0.8, label="mean ΔE76")
    return figure


QUESTIONS = {"tables": tables, "figures": figures}
