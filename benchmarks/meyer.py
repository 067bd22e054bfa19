"""Reproduction of the tables and figures of Meyer 1988, for docs/reproductions.md."""

from collections.abc import Iterable, Sequence
from itertools import chain

import numpy as np

import uplift
from benchmarks import DOCS, MACBETH, Row, read_reference
from uplift.atlas.resampling import on_grid
from uplift.colorimetry.delta_e import delta_e_1976, lab
from uplift.common.arrays import Array
from uplift.extras.pages.figure import write_figure
from uplift.extras.pages.marks import Mark, line
from uplift.extras.pages.panels import Axis, Panel, draw
from uplift.extras.papers.wavelengths import meyer as paper
from uplift.extras.papers.wavelengths.quadrature import QuadratureRule
from uplift.extras.papers.wavelengths.sampling import RenderSetup, grid, make_setup

COLOURS = {"opponent": "#20509a", "cones": "#d1495b", "xyz": "#2e8b57"}
"""Colours of the spaces AC1C2, SML and XYZ of the paper."""
CHANNELS = ("A", "C1", "C2")
PICTURES = DOCS / "wavelengths"
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
    sampling = paper.combine_rules(setup, space, allocation)
    xyz = sampling.xyz(setup.curves(sampling.wavelengths))
    whites = sampling.powers @ sampling.to_xyz
    return delta_e_1976(setup.lab, lab(xyz, whites[:, None])).mean()


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


def trials(setup: RenderSetup, name: str) -> tuple[Array, Array]:
    """Evaluate all allocations of defined orders up to 10 in a space: numbers of
    wavelengths (T, 3) and mean ΔE76 (T,).
    """
    space = matrix(setup, name)
    allocations = list(paper.allocations(setup, space))
    counts = [list(map(len, allocation)) for allocation in allocations]
    errors = [mean_error(setup, space, allocation) for allocation in allocations]
    return np.array(counts), np.array(errors)


def means(at: Array, errors: Array, label: str, colour: str) -> Mark:
    """Draw the means of the errors over the values (T,) at which they are."""
    x = np.unique(at)
    y = [errors[at == value].mean() for value in x]
    return line(x, y, label, colour, marker="o", markersize=3)


def figures() -> None:
    """Draw figure 6, mean and smallest errors of all allocations, and figure 7."""
    setup = checker()
    by_space = {name: trials(setup, name) for name in COLOURS}
    of_totals = []
    for name, (counts, errors) in by_space.items():
        totals = counts.sum(axis=1)
        of_totals.append(means(totals, errors, name, COLOURS[name]))
    counts, errors = by_space["opponent"]
    shares = (counts / counts.sum(axis=1, keepdims=True)).round(1)
    styles = zip(shares.T, CHANNELS, COLOURS.values(), strict=True)
    of_shares = [means(share, errors, *style) for share, *style in styles]
    error = Axis("mean ΔE76", log=True)
    plots = {
        "figure-6.png": Panel(of_totals, "", Axis("wavelengths"), error),
        "figure-7.png": Panel(of_shares, "", Axis("share of the wavelengths"), error),
    }
    for name, panel in plots.items():
        figure = draw([panel], size=(7.2, 3.6), legend="above")
        write_figure(figure, PICTURES / name, force=True)


QUESTIONS = {"tables": tables, "figures": figures}
