"""Meyer's matrices and tables beside ours."""

from __future__ import annotations

import numpy as np

from benchmarks.page import table
from benchmarks.wavelengths import printed
from uplift.common.arrays import Array
from uplift.scene.quadrature import QuadratureRule, UndefinedRule, gauss_rule
from uplift.scene.wavelengths import RenderSetup
from uplift.scene.wavelengths.experiments import allocation_error
from uplift.scene.wavelengths.meyer import (
    POINTS,
    ChannelRules,
    channel_functions,
    four_wavelength_rule,
    quadrature_rules,
)
from uplift.scene.wavelengths.opponent import ChannelSpace, OpponentSpace, cone_space

STEPS = {"100 steps of 3.9 nm": POINTS, "1 nm": np.arange(380.0, 771.0), "5 nm": np.arange(380.0, 771.0, 5)}
"""Ways to sum the functions from 380 to 770 nm."""


def matrices(setting: RenderSetup, opponent: OpponentSpace) -> str:
    spaces = {"SML": cone_space(setting.wavelengths, setting.cmfs), "AC1C2": opponent.space}
    lines = []
    for row in printed.rows("matrices"):
        space = spaces[row["space"]]
        index = space.channels.index(row["channel"])
        stated = np.array([float(row[axis]) for axis in "XYZ"])
        ours = space.matrix[index]
        value = opponent.eigenvalues[index] if row["eigenvalue"] else None
        lines.append(
            [
                row["channel"],
                _numbers(stated, 4),
                _numbers(ours, 4),
                f"{np.abs(stated - ours).max():.4f}",
                row["eigenvalue"],
                "" if value is None else f"{value:.4g}",
            ]
        )
    return table(
        "The opponent space: equations 1, 9 and 10",
        "Each channel as a sum of X, Y, Z: cones from the confusion points and two ratios of appendix A, the opponent "
        "channels as their principal axes. CIE 1931, 380–770 nm at 1 nm.",
        ["channel", "printed", "ours", "largest difference", "eigenvalue, printed", "ours"],
        lines,
    )


def quadrature(setting: RenderSetup, space: ChannelSpace) -> str:
    """Tables 1a and 1b: wavelengths, then weights."""
    ours, stated = quadrature_rules(space, setting.wavelengths, setting.cmfs), printed.tables_1()
    factor = _factor(ours, stated)
    nodes, weights = [], []
    for channel, orders in zip(printed.CHANNELS, ours, strict=True):
        for order, rule in orders.items():
            if isinstance(rule, UndefinedRule):
                told = "undefined" if (channel, order) not in stated else "defined"
                nodes.append([channel, str(order), told, f"undefined: {rule.reason}", ""])
                continue
            pairs = zip(stated[channel, order], (rule.nodes, factor * rule.weights), (1, 5), strict=True)
            for (as_printed, found, digits), lines in zip(pairs, (nodes, weights), strict=True):
                apart = f"{np.abs(as_printed - found).max():.{digits + 1 if digits == 1 else digits}f}"
                lines.append(
                    [channel, str(order), _numbers(as_printed, digits), _numbers(found, digits), apart]
                )
    head = ["channel", "order", "printed", "ours", "largest difference"]
    return table("Tables 1a and 1b: wavelengths", _sums(setting, space), head, nodes) + table(
        "Tables 1a and 1b: weights",
        f"Ours times {factor:.6f}, one factor for all: the paper does not say what its weights are relative to.",
        head,
        weights,
    )


def _sums(setting: RenderSetup, space: ChannelSpace) -> str:
    """How the sums that integrals are taken by decide the outer wavelengths."""
    told = []
    for name, points in STEPS.items():
        cmfs = np.stack([np.interp(points, setting.wavelengths, cmf) for cmf in setting.cmfs.T])
        differences = []
        for (channel, order), (nodes, _) in printed.tables_1().items():
            rule = gauss_rule(points, (space.matrix @ cmfs)[space.channels.index(channel)], order)
            if isinstance(rule, QuadratureRule):
                differences.append(np.abs(rule.nodes - nodes).max())
        told.append(f"by {name} {max(differences):.2f} nm")
    return (
        "The paper does not say by which sums it took its integrals, and the outer wavelengths of high orders depend "
        f"on it. Largest difference from all printed wavelengths: {', '.join(told)}. So the paper must have summed "
        "101 samples, and so do we. Undefined orders are the paper's: a node outside 380–770 nm, or no real ones."
    )


def four_wavelengths(setting: RenderSetup, space: ChannelSpace) -> str:
    """Table 2."""
    ours = quadrature_rules(space, setting.wavelengths, setting.cmfs)
    plain = tuple(orders[order] for orders, order in zip(ours, (3, 2, 1), strict=True))
    shared = four_wavelength_rule(ours, channel_functions(space, setting.wavelengths, setting.cmfs))
    factor = _factor(ours, printed.tables_1())
    lines = []
    for row, way in (("1", plain), ("2", shared)):
        stated, stated_error = printed.table_2(row)
        for channel, (nodes, weights), rule in zip(printed.CHANNELS, stated, way, strict=True):
            first = channel == printed.CHANNELS[0]
            lines.append(
                [
                    row if first else "",
                    channel,
                    f"{_numbers(nodes, 1)}: {_numbers(weights, 5)}",
                    f"{_numbers(rule.nodes, 1)}: {_numbers(factor * rule.weights, 5)}",
                    f"{stated_error:.3f}" if first else "",
                    f"{allocation_error(setting, space, way):.3f}" if first else "",
                ]
            )
    return table(
        "Table 2: four wavelengths",
        "Mean ΔE76 of the ColorChecker under C. Ours is Ohta's measurement, the paper's was read from McCamy et al. "
        "1976; the white of L\\*a\\*b\\* is the light seen through the same wavelengths.",
        ["row", "channel", "printed: wavelengths and weights", "ours", "ΔE76, printed", "ours"],
        lines,
    )


def _factor(ours: ChannelRules, stated: dict[tuple[str, int], printed.Nodes]) -> float:
    """What our weights must be multiplied by to be the printed ones, best over all."""
    pairs = [
        (rule.weights, stated[channel, order][1])
        for channel, orders in zip(printed.CHANNELS, ours, strict=True)
        for order, rule in orders.items()
        if isinstance(rule, QuadratureRule)
    ]
    found, as_printed = (np.concatenate(part) for part in zip(*pairs, strict=True))
    return float(found @ as_printed / (found @ found))


def _numbers(values: Array, digits: int) -> str:
    return ", ".join(f"{value:.{digits}f}" for value in values)
