"""Samples at the nodes of Gaussian quadrature (GQ), whose weight is the eye: x̄ + ȳ + z̄.

With n nodes the rule is exact for polynomials of degree 2n − 1 against that weight; each colour-matching function's
own rule at the same nodes, for degree n − 1. A spectrum is multiplied as point samples are.
"""

from __future__ import annotations

import numpy as np

from uplift.common.errors import UpliftError
from uplift.scene.quadrature import Undefined, gauss, interpolatory
from uplift.scene.representations.dense import observed, wavelengths
from uplift.scene.representations.point import hats_of_dense
from uplift.scene.representations.samples import Samples


def quadrature(count: int) -> Samples:
    """``count`` nodes."""
    rule = gauss(wavelengths(), observed().sum(axis=1), count)
    if isinstance(rule, Undefined):
        raise UpliftError(f"no rule of {count} nodes: {rule.reason}")
    seen = [interpolatory(rule.nodes, wavelengths(), masses).weights for masses in observed().T]
    return Samples(f"GQ{count}", "Gaussian quadrature", hats_of_dense(rule.nodes), np.stack(seen, axis=1))
