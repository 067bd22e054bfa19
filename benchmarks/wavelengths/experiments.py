"""Experiments of Meyer 1988, section 4.1: the space for quadrature, and the allocation of nodes to its channels.

Reference: Meyer 1988, "Wavelength selection for synthetic image generation", Computer Vision, Graphics, and Image
Processing 41(1), table 2 and figures 6 and 7.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.delta_e import delta_e_1976, lab
from uplift.common.arrays import Array
from uplift.scene.quadrature import QuadratureRule
from uplift.scene.wavelengths.meyer import Allocation, ChannelSpace, allocations, quadrature_rules
from uplift.scene.wavelengths.sampling import RenderSetup


@dataclass(frozen=True, eq=False)
class Trials:
    """Mean errors of every allocation of orders to the channels of a space.

    Parameters
    ----------
    space : ChannelSpace
        The space.
    counts : ndarray, shape (T, 3)
        Number of wavelengths of each channel.
    errors : ndarray, shape (T,)
        Mean ΔE76 over materials and lights.
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

    Parameters
    ----------
    corners : ndarray, shape (S, 3, 3)
        Shares at the corners of every small triangle that contains a trial.
    errors : ndarray, shape (S,)
        Mean error of the trials in each.
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
