"""Wavelengths by Gaussian quadrature with colour channels as weights: Meyer 1988, sections 3 and 4."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.scene.quadrature import QuadratureRule, UndefinedRule, gauss_rule, interpolatory_rule
from uplift.scene.wavelengths.opponent import ChannelSpace, opponent_space
from uplift.scene.wavelengths.sampling import Sampling, evaluate
from uplift.scene.wavelengths.setup import RenderSetup, interp_curves

POINTS = np.linspace(380.0, 770.0, 101)
"""Where the paper must have summed its functions, a hundred steps of 3.9 nm: with these its tables come out to the
last digit; with sums over every nanometre the outer wavelengths of high orders lie up to 5 nm off."""
MAX_ORDER = 10
"""The highest order of the paper's tables."""

ChannelRules = tuple[Mapping[int, QuadratureRule | UndefinedRule], ...]
"""For each channel, order → rule."""


def channel_functions(space: ChannelSpace, wavelengths: Array, cmfs: Array) -> Array:
    """(3, 101) the channels of a space at `POINTS`, times the step."""
    return (POINTS[1] - POINTS[0]) * space.matrix @ interp_curves(POINTS, wavelengths, cmfs.T)


def quadrature_rules(
    space: ChannelSpace, wavelengths: Array, cmfs: Array, most: int = MAX_ORDER
) -> ChannelRules:
    """Rules of orders 1 to ``most`` of the three channels of a space: tables 1a and 1b for AC1C2."""
    weights = channel_functions(space, wavelengths, cmfs)
    return tuple(
        {order: gauss_rule(POINTS, masses, order) for order in range(1, most + 1)} for masses in weights
    )


def allocations(
    quadrature_rules: ChannelRules, count: int | None = None
) -> Iterator[tuple[QuadratureRule, QuadratureRule, QuadratureRule]]:
    """Every way to give each channel a rule; only those of ``count`` wavelengths together, if given."""
    defined = [
        [rule for rule in channel.values() if isinstance(rule, QuadratureRule)]
        for channel in quadrature_rules
    ]
    for first, second, third in itertools.product(*defined):
        if count is None or len(first) + len(second) + len(third) == count:
            yield first, second, third


def four_wavelength_rule(
    quadrature_rules: ChannelRules, weights: Array
) -> tuple[QuadratureRule, QuadratureRule, QuadratureRule]:
    """Table 2, second row: A takes the two wavelengths of C1 and its own middle one, C2 has one of its own.

    ``weights`` (3, 101) are the space's `channel_functions`.
    """
    a, c1, c2 = quadrature_rules[0][3], quadrature_rules[1][2], quadrature_rules[2][1]
    if isinstance(a, UndefinedRule) or isinstance(c1, UndefinedRule) or isinstance(c2, UndefinedRule):
        raise OptionError(
            "the observer's opponent channels lack these rules", hint="take another method or observer"
        )
    return interpolatory_rule([*c1.nodes, a.nodes[1]], POINTS, weights[0]), c1, c2


def combine_rules(setting: RenderSetup, space: ChannelSpace, channels: Sequence[QuadratureRule]) -> Sampling:
    """One rule a channel → the wavelengths of all of them, lights read off there, weights to XYZ."""
    nm = np.unique(np.concatenate([rule.nodes for rule in channels]))
    weights = np.zeros((len(nm), 3))
    for channel, rule in enumerate(channels):
        weights[np.searchsorted(nm, rule.nodes), channel] = rule.weights
    step = setting.wavelengths[1] - setting.wavelengths[0]
    to_xyz = weights @ np.linalg.inv(space.matrix).T / step
    return Sampling(nm, to_xyz, setting.lights, setting.sampled_powers(nm))


def meyer(setting: RenderSetup, count: int) -> Sampling:
    """The allocation of ``count`` wavelengths to A, C1 and C2 of least mean ΔE00 in the setting; whites balanced.

    The paper leaves the allocation open; the best one that it could have taken flatters it.

    Raises
    ------
    OptionError : fewer wavelengths than the channels need, or more than orders up to 10 have.
    """
    nm, cmfs = setting.wavelengths, setting.cmfs
    space = opponent_space(nm, cmfs).space
    found = quadrature_rules(space, nm, cmfs)
    ways = list(allocations(found, count))
    if count == 4:
        ways.append(four_wavelength_rule(found, channel_functions(space, nm, cmfs)))
    if not ways:
        raise OptionError(f"Meyer's rules have no set of {count} wavelengths", hint="give a count of 4 to 30")
    return min(
        (combine_rules(setting, space, way).balanced() for way in ways),
        key=lambda combine_rules: evaluate(setting, combine_rules).mean,
    )
