"""Wavelengths by Gaussian quadrature with colour channels as weight functions.

Reference: Meyer 1988, "Wavelength selection for synthetic image generation", Computer
Vision, Graphics, and Image Processing 41(1). Sections 2.1, 2.2 and appendix A: cones
from confusion points, rotated to their principal axes. Sections 3 and 4: quadrature,
tables 1a, 1b and 2.
"""

import itertools
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.text import pluralise
from uplift.extras.papers.wavelengths.quadrature import (
    QuadratureRule,
    gauss_rule,
    interpolatory_rule,
)
from uplift.extras.papers.wavelengths.sampling import (
    RenderSetup,
    Sampling,
    balanced,
    evaluate,
    interp_curves,
)

CONFUSION_POINTS = np.array([[0.171, -0.003], [1.14, -0.14], [0.735, 0.265]])
"""Chromaticities xy at which the confusion lines of tritanopes, deuteranopes and
protanopes meet. They belong to the S, M and L cones alone (eq. 20; Estévez 1979).
"""
UNIQUE_BLUE = 475.5
"""Wavelength in nm of a blue whose hue does not depend on luminance."""
UNIQUE_YELLOW = 570.0
"""The same of a yellow."""
S_TO_ML_AT_BLUE = 1 / 16
"""Cone ratio s / (m + l) at the unique blue (eq. 21; Walraven 1974)."""
L_TO_M_AT_YELLOW = 2.0
"""Cone ratio l / m at the unique yellow."""


def cone_space(wavelengths: Array, cmfs: Array) -> Array:
    """Matrix (3, 3) from XYZ to S, M and L, for colour-matching functions (N, 3) at
    (N,) nm, the peak of l at 1.

    The confusion points are the chromaticities of the cone primaries, which determine
    the fundamentals up to a factor each. Two cone ratios and the peak determine the
    factors (eq. 1).
    """
    primaries = np.column_stack([CONFUSION_POINTS, 1 - CONFUSION_POINTS.sum(axis=1)])
    unscaled = np.linalg.inv(primaries.T)

    def response(nm: float) -> Array:
        return unscaled @ [np.interp(nm, wavelengths, cmf) for cmf in cmfs.T]

    yellow = response(UNIQUE_YELLOW)
    blue = response(UNIQUE_BLUE)
    long = 1 / (cmfs @ unscaled[2]).max()
    medium = long * yellow[2] / yellow[1] / L_TO_M_AT_YELLOW
    short = S_TO_ML_AT_BLUE * (medium * blue[1] + long * blue[2]) / blue[0]
    return np.array([short, medium, long])[:, None] * unscaled


def opponent_space(wavelengths: Array, cmfs: Array) -> tuple[Array, Array]:
    """Karhunen–Loève transform of the cones for spectra with uncorrelated wavelengths
    (eq. 3–10).

    Returns the matrix (3, 3) from XYZ to A, C1 and C2, by descending eigenvalue, and
    the eigenvalues (3,): the squared errors of omitting a channel. Each peaks at 1 or
    −1. A and C1 increase with Y, C2 with Z.
    """
    fundamentals = cone_space(wavelengths, cmfs)
    responses = cmfs @ fundamentals.T
    step = wavelengths[1] - wavelengths[0]
    values, vectors = np.linalg.eigh(responses.T @ responses * step)
    matrix = vectors[:, ::-1].T @ fundamentals
    matrix /= np.abs(cmfs @ matrix.T).max(axis=0)[:, None]
    matrix *= np.sign(matrix[[0, 1, 2], [1, 1, 2]])[:, None]
    return matrix, values[::-1]


SPACES: dict[str, Callable[[Array, Array], Array]] = {
    "opponent": lambda wavelengths, cmfs: opponent_space(wavelengths, cmfs)[0],
    "cones": cone_space,
    "xyz": lambda wavelengths, cmfs: np.eye(3),
}
"""Matrices of channels by name: functions of wavelengths (N,) in nm and colour-matching
functions (N, 3).
"""


POINTS = np.linspace(380.0, 770.0, 101)
"""Points in nm of the paper's sums, inferred from its tables: 100 steps of 3.9 nm
reproduce every printed digit. Sums over every nanometre move the outer wavelengths of
high orders by up to 5 nm.
"""
MAX_ORDER = 10
"""Highest order of tables 1a and 1b."""

Rules = tuple[QuadratureRule, ...]
"""A rule for each channel."""


def channel_functions(space: Array, wavelengths: Array, cmfs: Array) -> Array:
    """Channels (3, 101) of a space, by its matrix, at `POINTS`, multiplied
    by the step.
    """
    return (POINTS[1] - POINTS[0]) * space @ interp_curves(POINTS, wavelengths, cmfs.T)


def quadrature_rules(
    space: Array, wavelengths: Array, cmfs: Array
) -> list[dict[int, QuadratureRule | str]]:
    """Rules of orders 1 to `MAX_ORDER` for each channel of a space, or why there is
    none (tables 1a and 1b).
    """

    def rule(masses: Array, order: int) -> QuadratureRule | str:
        try:
            return gauss_rule(POINTS, masses, order)
        except OptionError as error:
            return error.problem

    functions = channel_functions(space, wavelengths, cmfs)
    orders = range(1, MAX_ORDER + 1)
    rules = []
    for masses in functions:
        rules.append({order: rule(masses, order) for order in orders})
    return rules


def allocations(
    setup: RenderSetup, space: Array, count: int | None = None
) -> Iterator[Rules]:
    """Yield every combination of defined rules, or only those of ``count`` wavelengths
    in total.
    """
    rules = quadrature_rules(space, setup.wavelengths, setup.cmfs)
    defined = []
    for channel in rules:
        usable = [rule for rule in channel.values() if isinstance(rule, QuadratureRule)]
        defined.append(usable)
    for combination in itertools.product(*defined):
        if count is None or sum(map(len, combination)) == count:
            yield combination


def four_wavelength_rule(functions: Array) -> Rules:
    """Rule of table 2, second row, in which A shares the two wavelengths of C1.

    A also has the middle node of the rule of order 3, and C2 has one node.
    ``functions`` (3, 101) are the `channel_functions` of the space. Raises
    `OptionError` where the observer has no such rules.
    """
    a, c1, c2 = (
        gauss_rule(POINTS, masses, order)
        for masses, order in zip(functions, (3, 2, 1), strict=True)
    )
    return interpolatory_rule([*c1.nodes, a.nodes[1]], POINTS, functions[0]), c1, c2


def combine_rules(
    setup: RenderSetup, space: Array, rules: Sequence[QuadratureRule]
) -> Sampling:
    """Sample the lights at the nodes of all channels, with weights that map the
    channels to XYZ.
    """
    nm = np.unique(np.concatenate([rule.nodes for rule in rules]))
    weights = np.zeros((len(nm), 3))
    for channel, rule in enumerate(rules):
        weights[np.searchsorted(nm, rule.nodes), channel] = rule.weights
    step = setup.wavelengths[1] - setup.wavelengths[0]
    to_xyz = weights @ np.linalg.inv(space).T / step
    return Sampling(
        nm, to_xyz, setup.lights, interp_curves(nm, setup.wavelengths, setup.powers)
    )


def meyer_orders(setup: RenderSetup, orders: Sequence[int], space: Array) -> Sampling:
    """Quadrature of a given order for each channel of a space; whites balanced. Raises
    `OptionError` without a rule.
    """
    if not all(1 <= order <= MAX_ORDER for order in orders):
        problem = f"orders must be in [1, {MAX_ORDER}], got {orders}"
        raise OptionError(problem, hint="the paper tabulates orders 1 to 10")
    functions = channel_functions(space, setup.wavelengths, setup.cmfs)
    rules = [
        gauss_rule(POINTS, masses, order)
        for masses, order in zip(functions, orders, strict=True)
    ]
    return balanced(combine_rules(setup, space, rules))


def meyer(setup: RenderSetup, count: int) -> Sampling:
    """Allocate ``count`` wavelengths to A, C1 and C2 with the least mean ΔE00 in the
    setup; whites balanced.

    The paper does not state how to allocate. The best allocation is an upper bound on
    the method. Raises `OptionError` if no allocation of orders 1 to 10 has ``count``
    wavelengths.
    """
    space, _ = opponent_space(setup.wavelengths, setup.cmfs)
    candidates = list(allocations(setup, space, count))
    if count == 4:
        candidates.append(
            four_wavelength_rule(
                channel_functions(space, setup.wavelengths, setup.cmfs)
            )
        )
    if not candidates:
        problem = f"method 'meyer' has no rule of {pluralise(count, 'wavelength')}"
        raise OptionError(
            problem, code="undefined-rule", hint="give a count in [4, 30]"
        )
    samplings = (
        balanced(combine_rules(setup, space, allocation)) for allocation in candidates
    )
    return min(samplings, key=lambda sampling: evaluate(setup, sampling).mean())
