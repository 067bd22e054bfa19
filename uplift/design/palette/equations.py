"""Stacked equations of a palette, M x ≈ y, where x holds free colours and spectra.

Colours are weighted by 1/√3 and smoothness by 1/(√rows ‖(−1, 2, −1)‖), so that weights of 1 are comparable.
Differences are scaled as for samples 10 nm apart. None extends beyond the ends, where the matrix of the paper has a
zero: flat spectra have no smoothness error here.

References
----------
S. Bergner, T. Möller, M. S. Drew, *A Spectral Engine for Visualization*, 2004, sections 3.2–3.3, eq. 18–24.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array
from uplift.design.palette.colours import screen_matrix
from uplift.design.palette.factor import FactorModel
from uplift.design.palette.palette import ColourGoal, Palette, SpectrumSpec
from uplift.fit.bounded_least_squares import BoundedProblem

SPACING = 10.0
"""Sample distance in nm that the weights of the paper refer to."""


@dataclass(frozen=True)
class Unknowns:
    """Positions in x: first free colours, then designed spectra (eq. 24)."""

    slices: dict[tuple[str, str], slice]
    count: int

    def free(self, name: str) -> slice:
        """Position of a free colour."""
        return self.slices["free", name]

    def light(self, name: str) -> slice:
        """Position of a designed light."""
        return self.slices["light", name]

    def material(self, name: str) -> slice:
        """Position of a designed material."""
        return self.slices["material", name]


@dataclass(frozen=True, eq=False)
class _Rows:
    """Some equations: blocks (r, k) with their positions in x, and values (r,)."""

    blocks: tuple[tuple[slice, Array], ...]
    values: Array


def unknowns(palette: Palette) -> Unknowns:
    """Positions of all unknowns of a palette."""
    samples = len(palette.sensor.wavelengths)
    sizes = {("free", name): 3 for name in palette.free}
    sizes |= {("light", spec.name): samples for spec in palette.lights if spec.designed}
    sizes |= {("material", spec.name): samples for spec in palette.materials if spec.designed}
    ends = np.cumsum([0, *sizes.values()])
    slices = {key: slice(int(a), int(b)) for key, a, b in zip(sizes, ends[:-1], ends[1:], strict=True)}
    return Unknowns(slices, int(ends[-1]))


def equations(palette: Palette, model: FactorModel) -> BoundedProblem:
    """Stack all criteria of non-zero weight (eq. 22)."""
    where = unknowns(palette)
    rows = [*_colour_rows(palette, model, where), *_smoothness_rows(palette, where)]
    rows += _model_error_rows(palette, model, where)
    matrix = np.zeros((sum(len(part.values) for part in rows), where.count))
    values = np.concatenate([part.values for part in rows]) if rows else np.zeros(0)
    top = 0
    for part in rows:
        for position, block in part.blocks:
            matrix[top : top + len(part.values), position] = block
        top += len(part.values)
    return BoundedProblem(matrix, values, *_bounds(palette, where))


def _colour_rows(palette: Palette, model: FactorModel, where: Unknowns) -> Iterator[_Rows]:
    """Target colours (eq. 18, or 19 in the factor model), and free ones, which are unknowns too (eq. 24)."""
    screen = screen_matrix(palette.sensor)
    by_model = palette.fit == "factor-model"
    for goal in palette.goals:
        spectrum, power = palette.material(goal.material).samples, palette.light(goal.light).samples
        weight, blocks = goal.weight / np.sqrt(3), []
        target = np.zeros(3) if goal.rgb is None else goal.rgb
        if power is not None:
            block = _modelled_material(model, power) if by_model else screen * power
            if spectrum is None:
                blocks.append((where.material(goal.material), weight * block))
            else:
                target = target - block @ spectrum
        elif spectrum is not None:
            block = _modelled_light(model, spectrum) if by_model else screen * spectrum
            blocks.append((where.light(goal.light), weight * block))
        if goal.free is not None:
            blocks.append((where.free(goal.free), -weight * np.eye(3)))
        if goal.weight and blocks:
            yield _Rows(tuple(blocks), weight * target)


def _smoothness_rows(palette: Palette, where: Unknowns) -> Iterator[_Rows]:
    """Second differences of every designed spectrum (eq. 21)."""
    if not palette.smoothness:
        return
    wavelengths = palette.sensor.wavelengths
    count = len(wavelengths) - 2
    differences = -np.diff(np.eye(len(wavelengths)), 2, axis=0) / (np.sqrt(count) * np.sqrt(6))
    step = wavelengths[1] - wavelengths[0]
    block = palette.smoothness * (SPACING / step) ** 2 * differences
    for _, position in _designed(palette, where):
        yield _Rows(((position, block),), np.zeros(count))


def _model_error_rows(palette: Palette, model: FactorModel, where: Unknowns) -> Iterator[_Rows]:
    """Colours of the factor model less those of full spectra, for every product with a designed spectrum (eq. 20)."""
    if not palette.model_error:
        return
    screen = screen_matrix(palette.sensor)
    weight = palette.model_error / np.sqrt(3)
    for material in palette.materials:
        for light in palette.lights:
            if material.samples is None and light.samples is not None:
                modelled = _modelled_material(model, light.samples)
                block, position = screen * light.samples - modelled, where.material(material.name)
            elif light.samples is None and material.samples is not None:
                modelled = _modelled_light(model, material.samples)
                block, position = screen * material.samples - modelled, where.light(light.name)
            else:
                continue
            yield _Rows(((position, weight * block),), np.zeros(3))


def _modelled_material(model: FactorModel, power: Array) -> Array:
    """Matrix (3, N) from a reflectance to its colour under a light, in the factor model."""
    return np.asarray(model.matrix * model.light(power) @ model.projection)


def _modelled_light(model: FactorModel, spectrum: Array) -> Array:
    """Matrix (3, N) from a light to the colour of a reflectance under it, in the factor model."""
    return np.asarray(model.matrix * model.reflectance(spectrum) @ model.light_projection)


def _designed(palette: Palette, where: Unknowns) -> Iterator[tuple[SpectrumSpec, slice]]:
    yield from ((spec, where.light(spec.name)) for spec in palette.lights if spec.designed)
    yield from ((spec, where.material(spec.name)) for spec in palette.materials if spec.designed)


def _bounds(palette: Palette, where: Unknowns) -> tuple[Array, Array]:
    low, high = np.empty(where.count), np.empty(where.count)
    for name, (lowest, highest) in palette.free.items():
        low[where.free(name)], high[where.free(name)] = lowest, highest
    for spec, position in _designed(palette, where):
        low[position], high[position] = spec.low, spec.high
    return low, high


def underdetermined_goal(palette: Palette) -> ColourGoal | None:
    """First goal whose light and material are both to be designed, which no linear equation describes."""
    for goal in palette.goals:
        if palette.material(goal.material).designed and palette.light(goal.light).designed:
            return goal
    return None
