"""Matrices and tables of Meyer 1988, printed and recomputed."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.wavelengths import printed
from benchmarks.wavelengths.experiments import allocation_error
from uplift.common.arrays import Array
from uplift.scene.quadrature import QuadratureRule, UndefinedRule, gauss_rule
from uplift.scene.wavelengths import RenderSetup
from uplift.scene.wavelengths.meyer import (
    POINTS,
    ChannelRules,
    ChannelSpace,
    OpponentSpace,
    channel_functions,
    cone_space,
    four_wavelength_rule,
    quadrature_rules,
)

STEPS = {"100 steps of 3.9 nm": POINTS, "1 nm": np.arange(380.0, 771.0), "5 nm": np.arange(380.0, 771.0, 5)}
"""Grids of the sums from 380 to 770 nm."""
Row = dict[str, Any]


def measure(setup: RenderSetup, opponent: OpponentSpace) -> dict[str, Any]:
    """Recompute the matrices, tables 1a and 1b, and table 2."""
    rules = quadrature_rules(opponent.space, setup.wavelengths, setup.cmfs)
    factor = weight_factor(rules)
    return {
        "opponent": matrices(setup, opponent),
        "summation": {name: summation(setup, opponent.space, points) for name, points in STEPS.items()},
        "weight_factor": factor,
        "nodes": nodes(rules),
        "weights": weights(rules, factor),
        "four": four_wavelengths(setup, opponent.space, rules, factor),
    }


def matrices(setup: RenderSetup, opponent: OpponentSpace) -> list[Row]:
    """Return each channel as a sum of X, Y and Z."""
    spaces = {"SML": cone_space(setup.wavelengths, setup.cmfs), "AC1C2": opponent.space}
    rows = []
    for row in printed.rows("matrices"):
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
    expected, rows = printed.tables_1(), []
    for channel, orders in zip(printed.CHANNELS, rules, strict=True):
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
    expected = printed.tables_1()
    return [
        {"channel": channel, "order": order, **_compared(expected[channel, order][1], factor * rule.weights)}
        for channel, orders in zip(printed.CHANNELS, rules, strict=True)
        for order, rule in orders.items()
        if isinstance(rule, QuadratureRule)
    ]


def summation(setup: RenderSetup, space: ChannelSpace, points: Array) -> float:
    """Return the largest difference from the printed wavelengths with sums over ``points``, in nm."""
    cmfs = np.stack([np.interp(points, setup.wavelengths, cmf) for cmf in setup.cmfs.T])
    functions = space.matrix @ cmfs
    differences = []
    for (channel, order), (expected, _) in printed.tables_1().items():
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
        expected, expected_error = printed.table_2(number)
        for channel, pair, rule in zip(printed.CHANNELS, expected, allocation, strict=True):
            first = channel == printed.CHANNELS[0]
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
    expected = printed.tables_1()
    pairs = [
        (rule.weights, expected[channel, order][1])
        for channel, orders in zip(printed.CHANNELS, rules, strict=True)
        for order, rule in orders.items()
        if isinstance(rule, QuadratureRule)
    ]
    ours, as_printed = (np.concatenate(part) for part in zip(*pairs, strict=True))
    return float(ours @ as_printed / (ours @ ours))
