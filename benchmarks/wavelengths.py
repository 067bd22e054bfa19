"""Selection of wavelengths, and reproduction of Meyer 1988, for docs/wavelengths.md and its pictures."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import uplift
from benchmarks import ATLASES, DOCS, MACBETH, read_reference, record
from uplift.atlas import on_grid
from uplift.colorimetry.delta_e import delta_e_1976, lab
from uplift.common.arrays import Array
from uplift.scene.quadrature import QuadratureRule, UndefinedRule, gauss_rule
from uplift.scene.wavelengths import METHODS, ColourErrors, choose, grid, make_setup
from uplift.scene.wavelengths.meyer import (
    POINTS,
    XYZ,
    Allocation,
    ChannelRules,
    ChannelSpace,
    allocations,
    channel_functions,
    cone_space,
    four_wavelength_rule,
    opponent_space,
    quadrature_rules,
)
from uplift.scene.wavelengths.sampling import RenderSetup, evaluate
from uplift.viz.figure import GREY, INK, STYLE, new_figure, style_axes, write_png

CHANNELS = ("A", "C1", "C2")
Nodes = tuple[Array, Array]
"""Wavelengths (n,) and weights (n,)."""


def tables_1() -> Mapping[tuple[str, int], Nodes]:
    """Return tables 1a and 1b by channel and order; undefined orders are absent."""
    lines = read_reference("meyer1988_table1.csv")
    keys = dict.fromkeys((row["channel"], int(row["order"])) for row in lines)
    return {key: _nodes(lines, "order", key[0], str(key[1])) for key in keys}


def table_2(row: str) -> tuple[list[Nodes], float]:
    """Return a row of table 2: the rules of the channels, and the error."""
    lines = read_reference("meyer1988_table2.csv")
    error = next(float(one["error"]) for one in lines if one["row"] == row)
    return [_nodes(lines, "row", channel, row) for channel in CHANNELS], error


def _nodes(lines: list[dict[str, str]], key: str, channel: str, value: str) -> Nodes:
    own = [row for row in lines if row["channel"] == channel and row[key] == value]
    return tuple(np.array([float(row[part]) for row in own]) for part in ("wavelength", "weight"))


@dataclass(frozen=True, eq=False)
class Trials:
    """Mean errors of every allocation of orders to the channels of a space.

    ``space``: the space.
    ``counts`` (T, 3): number of wavelengths of each channel.
    ``errors`` (T,): mean ΔE76 over materials and lights.
    """

    space: ChannelSpace
    counts: Array
    errors: Array

    @property
    def by_total(self) -> tuple[Array, Array]:
        """Total numbers of wavelengths in ascending order, and the mean error of each (figure 6)."""
        totals = self.counts.sum(axis=1)
        unique = np.unique(totals)
        return unique, np.array([self.errors[totals == total].mean() for total in unique])

    @property
    def shares(self) -> Array:
        """Share (T, 3) of the wavelengths that each channel has (figure 7)."""
        return self.counts / self.counts.sum(axis=1, keepdims=True)


def run_trials(setup: RenderSetup, space: ChannelSpace) -> Trials:
    """Evaluate every allocation of defined orders up to 10."""
    candidates = list(allocations(quadrature_rules(space, setup.wavelengths, setup.cmfs)))
    channels = {rule: _channel(setup, rule) for allocation in candidates for rule in allocation}
    counts = [[len(rule) for rule in allocation] for allocation in candidates]
    errors = [_mean_error(setup, space, [channels[rule] for rule in allocation]) for allocation in candidates]
    return Trials(space, np.array(counts), np.array(errors))


def allocation_error(setup: RenderSetup, space: ChannelSpace, allocation: Allocation) -> float:
    """Mean ΔE76 of one allocation (table 2)."""
    return _mean_error(setup, space, [_channel(setup, rule) for rule in allocation])


def _channel(setup: RenderSetup, rule: QuadratureRule) -> Array:
    """Channel values (K, M + 1) of the materials and, last, of the perfect reflector."""
    powers = setup.sampled_powers(rule.nodes) * rule.weights
    return np.concatenate([powers @ setup.curves(rule.nodes).T, powers.sum(axis=1, keepdims=True)], axis=1)


def _mean_error(setup: RenderSetup, space: ChannelSpace, channels: Sequence[Array]) -> float:
    """Mean ΔE76 of three channels (K, M + 1), whose last value is the white that L*a*b* refers to.

    The paper uses the light itself as white. Sampled at the same wavelengths as the materials, as here, it comes
    close to the printed errors; sampled at all wavelengths it does not.
    """
    xyz = np.stack(channels, axis=-1) @ np.linalg.inv(space.matrix).T
    colours = np.stack([lab(under_light[:-1], under_light[-1]) for under_light in xyz])
    return float(delta_e_1976(setup.lab, colours).mean())


@dataclass(frozen=True, eq=False)
class BinnedShares:
    """Triangle of shares, divided into small triangles (figure 7).

    ``corners`` (S, 3, 3): shares at the corners of every small triangle that contains a trial.
    ``errors`` (S,): mean error of the trials in each.
    """

    corners: Array
    errors: Array


def bin_shares(trials: Trials, divisions: int = 10) -> BinnedShares:
    """Average the errors over small triangles, ``divisions`` to an edge."""
    scaled = trials.shares * divisions
    # A trial on a line belongs to one side of it, regardless of rounding.
    floors = np.floor(scaled + 1e-9).astype(int)
    floors -= (floors.sum(axis=1) == divisions)[:, None] * np.eye(3, dtype=int)[floors.argmax(axis=1)]
    cells, cell_of = np.unique(floors, axis=0, return_inverse=True)
    cell_of = cell_of.ravel()
    errors = np.array([trials.errors[cell_of == cell].mean() for cell in range(len(cells))])
    upright = (cells.sum(axis=1) == divisions - 1)[:, None, None]
    corners = cells[:, None, :] + np.where(upright, np.eye(3), 1 - np.eye(3))
    return BinnedShares(corners / divisions, errors)


STEPS = {"100 steps of 3.9 nm": POINTS, "1 nm": np.arange(380.0, 771.0), "5 nm": np.arange(380.0, 771.0, 5)}
"""Grids of the sums from 380 to 770 nm."""
Row = dict[str, Any]


def compare_meyer(setup: RenderSetup, opponent: ChannelSpace) -> dict[str, Any]:
    """Recompute the matrices, tables 1a and 1b, and table 2."""
    rules = quadrature_rules(opponent, setup.wavelengths, setup.cmfs)
    factor = weight_factor(rules)
    return {
        "opponent": matrices(setup, opponent),
        "summation": {name: summation(setup, opponent, points) for name, points in STEPS.items()},
        "weight_factor": factor,
        "nodes": nodes(rules),
        "weights": weights(rules, factor),
        "four": four_wavelengths(setup, opponent, rules, factor),
    }


def matrices(setup: RenderSetup, opponent: ChannelSpace) -> list[Row]:
    """Return each channel as a sum of X, Y and Z."""
    spaces = {"SML": cone_space(setup.wavelengths, setup.cmfs), "AC1C2": opponent}
    rows = []
    for row in read_reference("meyer1988_matrices.csv"):
        space = spaces[row["space"]]
        index = space.channels.index(row["channel"])
        expected, ours = np.array([float(row[axis]) for axis in "XYZ"]), space.matrix[index]
        eigenvalue = (
            {"printed": float(row["eigenvalue"]), "ours": float(opponent.eigenvalues[index])}
            if row["eigenvalue"]
            else {"printed": None, "ours": None}
        )
        rows.append({"channel": row["channel"], **_compared(expected, ours), "eigenvalue": eigenvalue})
    return rows


def _compared(expected: Array, ours: Array) -> Row:
    return {"printed": expected, "ours": ours, "difference": float(np.abs(expected - ours).max())}


def nodes(rules: ChannelRules) -> list[Row]:
    """Return the wavelengths of tables 1a and 1b; ``outside`` is the node that makes an order undefined."""
    expected, rows = tables_1(), []
    for channel, orders in zip(CHANNELS, rules, strict=True):
        for order, rule in orders.items():
            row: Row = {"channel": channel, "order": order}
            if isinstance(rule, UndefinedRule):
                stated = expected.get((channel, order))
                row |= {
                    "printed": stated and stated[0],
                    "ours": None,
                    "difference": None,
                    "undefined": rule.reason,
                }
            else:
                row |= {**_compared(expected[channel, order][0], rule.nodes), "undefined": None}
            rows.append(row)
    return rows


def weights(rules: ChannelRules, factor: float) -> list[Row]:
    """Return the weights of tables 1a and 1b."""
    expected = tables_1()
    return [
        {"channel": channel, "order": order, **_compared(expected[channel, order][1], factor * rule.weights)}
        for channel, orders in zip(CHANNELS, rules, strict=True)
        for order, rule in orders.items()
        if isinstance(rule, QuadratureRule)
    ]


def summation(setup: RenderSetup, space: ChannelSpace, points: Array) -> float:
    """Return the largest difference from the printed wavelengths with sums over ``points``, in nm."""
    cmfs = np.stack([np.interp(points, setup.wavelengths, cmf) for cmf in setup.cmfs.T])
    functions = space.matrix @ cmfs
    differences = []
    for (channel, order), (expected, _) in tables_1().items():
        rule = gauss_rule(points, functions[space.channels.index(channel)], order)
        if isinstance(rule, QuadratureRule):
            differences.append(float(np.abs(rule.nodes - expected).max()))
    return max(differences)


def four_wavelengths(setup: RenderSetup, space: ChannelSpace, rules: ChannelRules, factor: float) -> list[Row]:
    """Return table 2."""
    separate = tuple(orders[order] for orders, order in zip(rules, (3, 2, 1), strict=True))
    shared = four_wavelength_rule(rules, channel_functions(space, setup.wavelengths, setup.cmfs))
    rows = []
    for number, allocation in (("1", separate), ("2", shared)):
        expected, expected_error = table_2(number)
        for channel, pair, rule in zip(CHANNELS, expected, allocation, strict=True):
            first = channel == CHANNELS[0]
            errors = (expected_error, float(allocation_error(setup, space, allocation))) if first else (None, None)
            rows.append(
                {
                    "row": number if first else "",
                    "channel": channel,
                    "printed": {"wavelengths": pair[0], "weights": pair[1]},
                    "ours": {"wavelengths": rule.nodes, "weights": factor * rule.weights},
                    "delta_e": {"printed": errors[0], "ours": errors[1]},
                }
            )
    return rows


def weight_factor(rules: ChannelRules) -> float:
    """Return the factor that takes the recomputed weights to the printed ones, by least squares."""
    expected = tables_1()
    pairs = [
        (rule.weights, expected[channel, order][1])
        for channel, orders in zip(CHANNELS, rules, strict=True)
        for order, rule in orders.items()
        if isinstance(rule, QuadratureRule)
    ]
    ours, as_printed = (np.concatenate(part) for part in zip(*pairs, strict=True))
    return float(ours @ as_printed / (ours @ ours))


OPTIMISED, FITTED = "optimised", "fitted"
OTHERS = ("meyer", "uniform", "bins")
"""Methods that are not fitted to materials."""
COUNTS = range(4, 17)
SMOOTH, SPIKY = ("A", "B", "C", "D65"), ("FL2", "FL7", "FL11")

Errors = Mapping[tuple[str, int], ColourErrors]
"""By method and number of wavelengths."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """Errors on all materials, fitted to them, and on every second one, fitted to the others."""

    lights: tuple[str, ...]
    known: Errors
    unseen: Errors

    @property
    def by_materials(self) -> dict[str, Errors]:
        """The two tests by the name of their materials."""
        return {"unseen": self.unseen, "all": self.known}


def compare_methods(materials: Array, lights: tuple[str, ...]) -> Comparison:
    """Evaluate all methods with every number of wavelengths, under several lights at once."""
    setup = make_setup(materials, lights)
    odd = np.arange(len(materials)) % 2 == 1
    keys = [(method, count) for count in COUNTS for method in METHODS]
    known = {(method, count): choose(setup, count=count, method=method).errors for method, count in keys}
    unseen = {(method, count): _held_out(setup, odd, method, count) for method, count in keys}
    return Comparison(lights, known, unseen)


def _held_out(setup: RenderSetup, odd: Array, method: str, count: int) -> ColourErrors:
    """Evaluate on the odd materials. Methods that are not fitted get these, which favours Meyer's allocation."""
    tested = setup.only(odd)
    return evaluate(tested, METHODS[method](tested if method in OTHERS else setup.only(~odd), count))


def gains(errors: Errors) -> Array:
    """Return the ratio of the best other method's mean to the optimised one's, for every number of wavelengths."""
    return np.array(
        [min(errors[other, count].mean for other in OTHERS) / errors[OPTIMISED, count].mean for count in COUNTS]
    )


def error_rows(comparison: Comparison) -> Iterator[dict[str, Any]]:
    """Yield [mean, 95th percentile, largest] ΔE00 of every method."""
    for materials, errors in comparison.by_materials.items():
        for count, gain in zip(COUNTS, gains(errors).tolist(), strict=True):
            cells = {method: errors[method, count] for method in METHODS}
            yield {
                "lights": ", ".join(comparison.lights),
                "materials": materials,
                "count": count,
                "errors": {name: [float(one.mean), float(one.p95), float(one.max)] for name, one in cells.items()},
                "gain": gain,
            }


def summary(comparison: Comparison) -> Iterator[dict[str, Any]]:
    """Yield the ratios, and the fewest wavelengths for a mean of 1; None if 16 do not reach it."""
    for materials, errors in comparison.by_materials.items():
        fitted = np.array([errors[FITTED, count].mean / errors[OPTIMISED, count].mean for count in COUNTS])
        yield {
            "lights": ", ".join(comparison.lights),
            "materials": materials,
            "other_gain": _ratios(gains(errors)),
            "fitted_gain": _ratios(fitted),
            "needed": {method: _fewest(errors, method) for method in METHODS},
        }


def _ratios(ratios: Array) -> dict[str, float]:
    lowest = int(ratios.argmin())
    return {
        "median": float(np.median(ratios)),
        "min": float(ratios[lowest]),
        "min_count": COUNTS[lowest],
        "max": float(ratios.max()),
    }


def _fewest(errors: Errors, method: str) -> int | None:
    return next((count for count in COUNTS if errors[method, count].mean <= 1), None)


BOUNCE_COUNTS = (6, 8, 12)
PATHS = 400
BOUNCE_LIGHTS = ("D65", "FL11")


def bounces(materials: Array) -> list[dict[str, Any]]:
    """Return mean ΔE00 of random paths over one to three held-out materials."""
    odd = np.arange(len(materials)) % 2 == 1
    fitted = make_setup(materials[~odd], BOUNCE_LIGHTS)
    rng = np.random.default_rng(1)
    draws = [rng.choice(materials[odd], PATHS) for _ in range(3)]
    paths = [make_setup(np.prod(draws[: length + 1], axis=0), BOUNCE_LIGHTS) for length in range(3)]
    rows = []
    for count in BOUNCE_COUNTS:
        samplings = {name: method(fitted, count) for name, method in METHODS.items()}
        for length, path in enumerate(paths, 1):
            errors = {name: float(evaluate(path, sampling).mean) for name, sampling in samplings.items()}
            rows.append({"count": count, "materials": length, "errors": errors})
    return rows


COLOURS = ("#20509a", "#d1495b", "#2e8b57", "#c98a1b", "#7fa3d9")
CORNERS = np.array([[0.5, np.sqrt(0.75)], [0.0, 0.0], [1.0, 0.0]])
"""Corners where the first, second and third channel have all wavelengths."""


def figure_6(spaces: Sequence[Trials], path: Path) -> None:
    """Plot the mean over all allocations, and the best of them, over the number of wavelengths."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure = new_figure(7.2, 3.6)
        axes = figure.subplots()
        for trials, colour in zip(spaces, COLOURS, strict=False):
            totals, means = trials.by_total
            axes.plot(totals, means, "o-", color=colour, markersize=3, label=trials.space.name)
            best = [trials.errors[trials.counts.sum(axis=1) == total].min() for total in totals]
            axes.plot(totals, best, ":", color=colour)
        axes.plot([], [], "o-", color=GREY, markersize=3, label="mean of all allocations")
        axes.plot([], [], ":", color=GREY, label="best allocation")
        axes.set(xlabel="wavelengths", ylabel="mean ΔE76", yscale="log")
        axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
        axes.legend(frameon=False, ncols=2)
        style_axes(axes)
        write_png(figure, path, force=True)


def figure_7(trials: Trials, path: Path) -> None:
    """Plot the mean error as small triangles, darker for larger errors."""
    import matplotlib
    from matplotlib.collections import PolyCollection

    parts = bin_shares(trials)
    with matplotlib.rc_context(STYLE):
        figure = new_figure(6.0, 4.6)
        axes = figure.subplots()
        cells = PolyCollection(
            parts.corners @ CORNERS, array=parts.errors, cmap="viridis_r", edgecolors="white", linewidths=0.6
        )
        axes.add_collection(cells)
        axes.plot(*CORNERS[[0, 1, 2, 0]].T, color=GREY, linewidth=0.8)
        for name, (x, y), side in zip(trials.space.channels, CORNERS, ("bottom", "top", "top"), strict=True):
            axes.annotate(
                f"all for {name}",
                (x, y),
                xytext=(0, 5 if side == "bottom" else -5),
                textcoords="offset points",
                ha="center",
                va=side,
                color=INK,
                fontsize=9,
            )
        axes.set_aspect("equal")
        axes.set(xlim=(-0.12, 1.12), ylim=(-0.1, 0.97))
        axes.set_axis_off()
        figure.colorbar(cells, ax=axes, shrink=0.8, label="mean ΔE76")
        write_png(figure, path, force=True)


def plot_methods(comparisons: Sequence[Comparison], path: Path) -> None:
    """Plot mean ΔE00 on held-out materials over the number of wavelengths."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure = new_figure(7.2, 3.4)
        panels = figure.subplots(1, len(comparisons), sharey=True)
        for axes, comparison in zip(panels, comparisons, strict=True):
            for method, colour in zip(METHODS, COLOURS, strict=True):
                means = [comparison.unseen[method, count].mean for count in COUNTS]
                axes.plot(COUNTS, means, "o-", color=colour, markersize=3, label=method)
            axes.set(xlabel="wavelengths", yscale="log")
            axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
            axes.set_title(", ".join(comparison.lights), loc="left", fontsize=9, color=INK)
            style_axes(axes)
        panels[0].set_ylabel("mean ΔE00, unseen materials")
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=5, frameon=False)
        write_png(figure, path, force=True)


PICTURES = DOCS / "wavelengths"


def main() -> None:
    """Measure, draw and store."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    atlases = sorted((ATLASES).glob("*.txt"))
    checker = make_setup(on_grid(uplift.read_atlas(MACBETH), grid()), ["C"])
    opponent = opponent_space(checker.wavelengths, checker.cmfs)
    PICTURES.mkdir(exist_ok=True)
    spaces = (opponent, cone_space(checker.wavelengths, checker.cmfs), XYZ)
    trials = [run_trials(checker, space) for space in spaces]
    figure_6(trials, PICTURES / "figure-6.png")
    figure_7(trials[0], PICTURES / "figure-7.png")
    materials = on_grid(uplift.read_atlas(*atlases), grid())
    comparisons = [compare_methods(materials, lights) for lights in (SMOOTH, SPIKY)]
    plot_methods(comparisons, PICTURES / "methods.png")
    record(
        "wavelengths",
        materials=len(materials),
        summary=[row for comparison in comparisons for row in summary(comparison)],
        errors=[row for comparison in comparisons for row in error_rows(comparison)],
        bounce_paths=PATHS,
        bounce_lights=BOUNCE_LIGHTS,
        bounces=bounces(materials),
        **compare_meyer(checker, opponent),
    )


if __name__ == "__main__":
    main()
