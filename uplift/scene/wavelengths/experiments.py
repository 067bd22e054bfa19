"""The experiments of Meyer 1988, section 4.1: which space to do quadrature in, and which channel to favour."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.delta_e import delta_e_1976, lab
from uplift.common.arrays import Array
from uplift.scene.quadrature import QuadratureRule
from uplift.scene.wavelengths.meyer import allocations, quadrature_rules
from uplift.scene.wavelengths.opponent import ChannelSpace
from uplift.scene.wavelengths.setup import RenderSetup


@dataclass(frozen=True, eq=False)
class Trials:
    """Every way to allocate orders to the channels of a space.

    Parameters
    ----------
    space : the space.
    counts : (T, 3) wavelengths of each channel.
    errors : (T,) mean ΔE76 over materials and lights.
    """

    space: ChannelSpace
    counts: Array
    errors: Array

    @property
    def by_total(self) -> tuple[Array, Array]:
        """Totals of wavelengths, ascending, and the mean error of each: figure 6."""
        totals = self.counts.sum(axis=1)
        found = np.unique(totals)
        return found, np.array([self.errors[totals == total].mean() for total in found])

    @property
    def shares(self) -> Array:
        """(T, 3) of a trial's wavelengths that each channel has: figure 7."""
        return self.counts / self.counts.sum(axis=1, keepdims=True)


def run_trials(setting: RenderSetup, space: ChannelSpace) -> Trials:
    """Every allocation of defined orders up to 10 in a space, judged on a setting."""
    ways = list(allocations(quadrature_rules(space, setting.wavelengths, setting.cmfs)))
    seen = {rule: _channel(setting, rule) for way in ways for rule in way}
    counts, errors = [], []
    for way in ways:
        counts.append([len(rule) for rule in way])
        errors.append(_error(setting, space, np.stack([seen[rule] for rule in way], axis=-1)))
    return Trials(space, np.array(counts), np.array(errors))


def allocation_error(
    setting: RenderSetup, space: ChannelSpace, way: tuple[QuadratureRule, QuadratureRule, QuadratureRule]
) -> float:
    """Mean ΔE76 of one allocation: table 2."""
    return _error(setting, space, np.stack([_channel(setting, rule) for rule in way], axis=-1))


def _channel(setting: RenderSetup, rule: QuadratureRule) -> Array:
    """(K, M + 1) what a rule makes of the materials, and last of the perfect reflector."""
    lit = setting.sampled_powers(rule.nodes) * rule.weights
    return np.concatenate([lit @ setting.curves(rule.nodes).T, lit.sum(axis=1, keepdims=True)], axis=1)


def _error(setting: RenderSetup, space: ChannelSpace, channels: Array) -> float:
    """Mean ΔE76 of channel values (K, M + 1, 3) whose last is the white that L*a*b* refers to.

    The paper takes the light itself as white. Seen through the same few wavelengths as the materials, as here,
    it comes near the printed errors; seen through all of them it does not.
    """
    xyz = channels @ np.linalg.inv(space.matrix).T
    found = [lab(seen[:-1], seen[-1]) for seen in xyz]
    return float(delta_e_1976(setting.lab, np.stack(found)).mean())


@dataclass(frozen=True, eq=False)
class BinnedShares:
    """Figure 7: the triangle of shares, cut into small ones.

    Parameters
    ----------
    corners : (S, 3, 3) shares at the corners of every small triangle that holds a trial.
    errors : (S,) mean error of the trials in it.
    """

    corners: Array
    errors: Array


def bin_shares(run_trials: Trials, cuts: int = 10) -> BinnedShares:
    """Mean error over small triangles, ``cuts`` to an edge."""
    scaled = run_trials.shares * cuts
    # Rounding must not take a trial on a line to either side of it by chance.
    floors = np.floor(scaled + 1e-9).astype(int)
    floors -= (floors.sum(axis=1) == cuts)[:, None] * np.eye(3, dtype=int)[floors.argmax(axis=1)]
    cells, homes = np.unique(floors, axis=0, return_inverse=True)
    homes = homes.ravel()
    errors = np.array([run_trials.errors[homes == cell].mean() for cell in range(len(cells))])
    upright = (cells.sum(axis=1) == cuts - 1)[:, None, None]
    corners = cells[:, None, :] + np.where(upright, np.eye(3), 1 - np.eye(3))
    return BinnedShares(corners / cuts, errors)
