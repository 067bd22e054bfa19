"""Wavelengths by Gaussian quadrature with colour channels as weights: Meyer 1988, sections 3 and 4."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.scene.quadrature import Rule, Undefined, gauss, interpolatory
from uplift.scene.wavelengths.opponent import Space, opponent
from uplift.scene.wavelengths.sampling import Sampling, judge
from uplift.scene.wavelengths.setup import Setting, read_off

POINTS = np.linspace(380.0, 770.0, 101)
"""Where the paper must have summed its functions, a hundred steps of 3.9 nm: with these its tables come out to the
last digit; with sums over every nanometre the outer wavelengths of high orders lie up to 5 nm off."""
MOST = 10
"""The highest order of the paper's tables."""

Rules = tuple[Mapping[int, Rule | Undefined], ...]
"""For each channel, order → rule."""


def functions(space: Space, wavelengths: Array, cmfs: Array) -> Array:
    """(3, 101) the channels of a space at `POINTS`, times the step."""
    return (POINTS[1] - POINTS[0]) * space.matrix @ read_off(POINTS, wavelengths, cmfs.T)


def rules(space: Space, wavelengths: Array, cmfs: Array, most: int = MOST) -> Rules:
    """Rules of orders 1 to ``most`` of the three channels of a space: tables 1a and 1b for AC1C2."""
    weights = functions(space, wavelengths, cmfs)
    return tuple({order: gauss(POINTS, masses, order) for order in range(1, most + 1)} for masses in weights)


def allocations(rules: Rules, count: int | None = None) -> Iterator[tuple[Rule, Rule, Rule]]:
    """Every way to give each channel a rule; only those of ``count`` wavelengths together, if given."""
    defined = [[rule for rule in channel.values() if isinstance(rule, Rule)] for channel in rules]
    for first, second, third in itertools.product(*defined):
        if count is None or len(first) + len(second) + len(third) == count:
            yield first, second, third


def four(rules: Rules, weights: Array) -> tuple[Rule, Rule, Rule]:
    """Table 2, second row: A takes the two wavelengths of C1 and its own middle one, C2 has one of its own.

    ``weights`` (3, 101) are the space's `functions`.
    """
    a, c1, c2 = rules[0][3], rules[1][2], rules[2][1]
    if isinstance(a, Undefined) or isinstance(c1, Undefined) or isinstance(c2, Undefined):
        raise OptionError(
            "the observer's opponent channels lack these rules", hint="take another method or observer"
        )
    return interpolatory([*c1.nodes, a.nodes[1]], POINTS, weights[0]), c1, c2


def sampling(setting: Setting, space: Space, channels: Sequence[Rule]) -> Sampling:
    """One rule a channel → the wavelengths of all of them, lights read off there, weights to XYZ."""
    nm = np.unique(np.concatenate([rule.nodes for rule in channels]))
    weights = np.zeros((len(nm), 3))
    for channel, rule in enumerate(channels):
        weights[np.searchsorted(nm, rule.nodes), channel] = rule.weights
    step = setting.wavelengths[1] - setting.wavelengths[0]
    to_xyz = weights @ np.linalg.inv(space.matrix).T / step
    return Sampling(nm, to_xyz, setting.lights, setting.sampled_powers(nm))


def meyer(setting: Setting, count: int) -> Sampling:
    """The allocation of ``count`` wavelengths to A, C1 and C2 of least mean ΔE00 in the setting; whites balanced.

    The paper leaves the allocation open; the best one that it could have taken flatters it.

    Raises
    ------
    OptionError : fewer wavelengths than the channels need, or more than orders up to 10 have.
    """
    nm, cmfs = setting.wavelengths, setting.cmfs
    space = opponent(nm, cmfs).space
    found = rules(space, nm, cmfs)
    ways = list(allocations(found, count))
    if count == 4:
        ways.append(four(found, functions(space, nm, cmfs)))
    if not ways:
        raise OptionError(f"Meyer's rules have no set of {count} wavelengths", hint="give a count of 4 to 30")
    return min(
        (sampling(setting, space, way).balanced() for way in ways),
        key=lambda sampling: judge(setting, sampling).mean,
    )
