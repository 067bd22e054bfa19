"""Extreme reflectances of a colour: of all reflectances in [0, 1] with given RGB, the
one with the largest response.

maximise c · g subject to W g = r, 0 ≤ g ≤ 1, for many problems at once. With K numbers
r, three for each light that a colour is known under, g is 0 or 1 at the optimum but at
K wavelengths, the basis. The signs of the reduced responses u =
c − λ W put the others at a bound. A step exchanges the wavelength of the basis whose
reflectance violates [0, 1] most, and passes all changes of sign that still lower the
dual objective λ · r + Σ max(u, 0).

References
----------
Logvinenko, Funt & Godau 2014, "Metamer mismatching", IEEE Transactions on Image
Processing 23(1): the boundary of the mismatch volume consists of such reflectances.
Maros 2003, "A generalized dual phase-2 simplex algorithm", European Journal of
Operational Research 149(1): the step over several bounds.
"""

from typing import NamedTuple

import numpy as np

from uplift.common.arrays import Array, Indices, Mask, blocks

FEASIBLE = 1e-9
"""Violation of [0, 1] that counts as rounding."""
ROUNDING = 1e-10
"""Part of a violation that may remain at the boundary of the object-colour solid, where
the objective ends to fall.
"""
PERTURBATION = 1e-11
"""Size, relative to the largest response, of the changes that keep the reduced
responses away from 0.
"""
MAX_STEPS = 500
BLOCK_NUMBERS = 1 << 18
"""Reduced responses held at a time: they fit into the cache."""


class ExtremeSpectra(NamedTuple):
    """Optimal reflectances of n problems."""

    reflectance: Array
    """(n, N), 0 or 1 but at the basis."""
    basis: Indices
    """(n, K) wavelengths whose reflectance may lie between 0 and 1."""
    solved: Mask
    """(n,) True unless no reflectance has the colour, or rounding prevents a decision.
    """


def extreme_spectra(
    matrix: Array, rgb: Array, response: Array, basis: Indices | None = None
) -> ExtremeSpectra:
    """Find the reflectances of colours (n, K) with the largest responses (n, N), from a
    ``basis`` (n, K).
    """
    start = np.tile(first_basis(matrix), (len(rgb), 1)) if basis is None else basis
    spectra = ExtremeSpectra(
        np.empty(response.shape), start.copy(), np.zeros(len(rgb), dtype=bool)
    )
    for block in blocks(len(rgb), max(BLOCK_NUMBERS // matrix.shape[1], 1)):
        block_spectra = ExtremeSpectra(
            spectra.reflectance[block], spectra.basis[block], spectra.solved[block]
        )
        _solve(matrix, rgb[block], _perturbed(response[block]), block_spectra)
    return spectra


def first_basis(matrix: Array) -> Indices:
    """Choose wavelengths (K,) with independent colours: the largest part that those
    before do not share.
    """
    remaining = matrix.copy()
    chosen = []
    for _ in range(len(matrix)):
        lengths = np.linalg.norm(remaining, axis=0)
        chosen.append(int(lengths.argmax()))
        axis = remaining[:, chosen[-1]] / lengths[chosen[-1]]
        remaining -= np.outer(axis, axis @ remaining)
    return np.array(chosen)


def _perturbed(response: Array) -> Array:
    """Add distinct numbers, the same for all problems: equal ratios of responses could
    repeat a basis for ever.
    """
    count = response.shape[1]
    offsets = (np.arange(1, count + 1) * 0.6180339887498949) % 1 - 0.5
    return (
        response + PERTURBATION * np.abs(response).max(axis=1, keepdims=True) * offsets
    )


def _solve(matrix: Array, rgb: Array, response: Array, found: ExtremeSpectra) -> None:
    """Solve n problems in place."""
    pending = np.arange(len(rgb))
    for _ in range(MAX_STEPS):
        basis = found.basis[pending]
        reduced, inner, inverse, spectra = _state(
            matrix, rgb[pending], response[pending], basis
        )
        violation = np.maximum(inner - 1, -inner)
        worst = violation.argmax(axis=1)
        rows = np.arange(len(pending))
        done = violation[rows, worst] <= FEASIBLE
        finished = pending[done]
        spectra[rows[:, None], basis] = np.clip(inner, 0, 1)
        found.reflectance[pending] = spectra
        found.solved[finished] = True
        open_rows = rows[~done]
        if not len(open_rows):
            return
        leaving = worst[open_rows]
        upwards = np.where(inner[open_rows, leaving] > 1, 1.0, -1.0)
        entering, bounded = _entering(
            reduced[open_rows],
            upwards[:, None] * (inverse[open_rows, leaving] @ matrix),
            violation[open_rows, leaving],
            basis[open_rows],
        )
        pending = pending[open_rows[bounded]]
        found.basis[pending, leaving[bounded]] = entering[bounded]
        if not len(pending):
            return


def _state(
    matrix: Array, rgb: Array, response: Array, basis: Indices
) -> tuple[Array, Array, Array, Array]:
    """Reduced responses (n, N), reflectances (n, K) of the basis, inverse (n, K, K),
    reflectances (n, N) at bounds.
    """
    # λ = c_B W_B⁻¹ for the basis B, u = c − λ W, g = 1 where u > 0, and g_B = W_B⁻¹ (r
    # − W g)
    rows = np.arange(len(basis))[:, None]
    inverse = np.asarray(np.linalg.inv(matrix.T[basis].mT))
    multipliers = (np.take_along_axis(response, basis, axis=1)[:, None, :] @ inverse)[
        :, 0
    ]
    reduced = response - multipliers @ matrix
    reduced[rows, basis] = 0
    spectra = (reduced > 0).astype(float)
    inner = (inverse @ (rgb - spectra @ matrix.T)[:, :, None])[:, :, 0]
    return reduced, inner, inverse, spectra


def _entering(
    reduced: Array, rate: Array, violation: Array, basis: Indices
) -> tuple[Indices, Mask]:
    """Choose the wavelengths that enter the basis, and whether (n,) the dual objective
    ends to fall.

    Along the step reduced responses change at ``rate`` (n, N). Each change of sign
    raises the slope of the objective, which starts at minus the violation, by the size
    of the rate.
    """
    rows = np.arange(len(basis))[:, None]
    crosses = reduced * rate < 0
    crosses[rows, basis] = False
    length = np.divide(-reduced, rate, out=np.full_like(reduced, np.inf), where=crosses)
    order = np.argsort(length, axis=1)
    size = np.take_along_axis(np.where(crosses, np.abs(rate), 0), order, axis=1)
    passed = size.cumsum(axis=1) >= (violation - ROUNDING * (1 + violation))[:, None]
    return order[rows[:, 0], passed.argmax(axis=1)], np.asarray(passed[:, -1])
