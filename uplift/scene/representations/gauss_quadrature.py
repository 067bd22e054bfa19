"""Samples at the nodes of Gaussian quadrature (GQ) with the weight function x̄ + ȳ + z̄.

With n nodes the rule is exact for polynomials of degree 2n − 1 under that weight function. Each colour-matching
function has its own weights at the same nodes, exact for degree n − 1. Spectra are multiplied like point samples.
"""

from __future__ import annotations

import numpy as np

from uplift.common.errors import UpliftError
from uplift.scene.quadrature import UndefinedRule, gauss_rule, interpolatory_rule
from uplift.scene.representations.dense import interpolation_matrix, wavelengths, xyz_weights
from uplift.scene.representations.samples import SampleRepresentation


def gauss_samples(count: int) -> SampleRepresentation:
    """Make the representation by ``count`` nodes. Raises `UpliftError` if no such rule exists."""
    rule = gauss_rule(wavelengths(), xyz_weights().sum(axis=1), count)
    if isinstance(rule, UndefinedRule):
        raise UpliftError(
            f"order {count} has no quadrature rule: {rule.reason}",
            code="undefined-rule",
            hint="choose another number of nodes",
        )
    weights = [interpolatory_rule(rule.nodes, wavelengths(), masses).weights for masses in xyz_weights().T]
    encoder = interpolation_matrix(rule.nodes)
    return SampleRepresentation(f"GQ{count}", "Gaussian quadrature", encoder, np.stack(weights, axis=1))
