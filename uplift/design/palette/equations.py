"""The stacked equations of a palette: M x ≈ y, x being free colours and spectra (Bergner, 3.2–3.3, eq. 18–24).

Colours are weighed by 1/√3 and smoothness by 1/(√rows ‖(−1, 2, −1)‖), so that weights of 1 mean the same. Differences
count as those of samples 10 nm apart, whatever the step, and none is taken beyond the ends, where the source's matrix
has a zero: flat spectra cost nothing here.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array
from uplift.design.palette.colours import screen_matrix
from uplift.design.palette.factor import FactorModel
from uplift.design.palette.palette import ColourGoal, Palette, SpectrumSpec

SPACING = 10.0
"""nm between the samples of the source, for which its weights are meant."""


@dataclass(frozen=True)
class Unknowns:
    """Where the unknowns stand in x: first free colours, then designed spectra (eq. 24)."""

    places: dict[tuple[str, str], slice]
    count: int

    def free(self, name: str) -> slice:
        return self.places["free", name]

    def light(self, name: str) -> slice:
        return self.places["light", name]

    def material(self, name: str) -> slice:
        return self.places["material", name]


@dataclass(frozen=True, eq=False)
class Equations:
    """matrix (rows, n), values (rows,), and bounds low, high (n,) of x."""

    matrix: Array
    values: Array
    low: Array
    high: Array


@dataclass(frozen=True, eq=False)
class _Rows:
    """Some equations: blocks (r, k) with their places in x, and values (r,)."""

    blocks: tuple[tuple[slice, Array], ...]
    values: Array


def unknowns(palette: Palette) -> Unknowns:
    """All that is to be found."""
    samples = len(palette.sensor.wavelengths)
    sizes = {("free", name): 3 for name in palette.free}
    sizes |= {("light", part.name): samples for part in palette.lights if part.designed}
    sizes |= {("material", part.name): samples for part in palette.materials if part.designed}
    ends = np.cumsum([0, *sizes.values()])
    places = {key: slice(int(a), int(b)) for key, a, b in zip(sizes, ends[:-1], ends[1:], strict=True)}
    return Unknowns(places, int(ends[-1]))


def equations(palette: Palette, model: FactorModel) -> Equations:
    """All criteria, stacked; those of weight 0 are left out (eq. 22)."""
    where = unknowns(palette)
    rows = [*_colours(palette, where), *_smooth(palette, where), *_model_errors(palette, model, where)]
    matrix = np.zeros((sum(len(part.values) for part in rows), where.count))
    values = np.concatenate([part.values for part in rows]) if rows else np.zeros(0)
    top = 0
    for part in rows:
        for place, block in part.blocks:
            matrix[top : top + len(part.values), place] = block
        top += len(part.values)
    return Equations(matrix, values, *_bounds(palette, where))


def _colours(palette: Palette, where: Unknowns) -> Iterator[_Rows]:
    """Wanted colours (eq. 18), and free ones, which stand among the unknowns (eq. 24)."""
    screen = screen_matrix(palette.sensor)
    for wish in palette.goals:
        spectrum, power = palette.material(wish.material).samples, palette.light(wish.light).samples
        weight, blocks = wish.weight / np.sqrt(3), []
        wanted = np.zeros(3) if wish.rgb is None else wish.rgb
        if spectrum is None and power is not None:
            blocks.append((where.material(wish.material), weight * screen * power))
        elif power is None and spectrum is not None:
            blocks.append((where.light(wish.light), weight * screen * spectrum))
        elif power is not None and spectrum is not None:
            wanted = wanted - screen @ (power * spectrum)
        if wish.free is not None:
            blocks.append((where.free(wish.free), -weight * np.eye(3)))
        if wish.weight and blocks:
            yield _Rows(tuple(blocks), weight * wanted)


def _smooth(palette: Palette, where: Unknowns) -> Iterator[_Rows]:
    """Second differences of every designed spectrum (eq. 21)."""
    if not palette.smoothness:
        return
    wavelengths = palette.sensor.wavelengths
    kernel = np.array([-1.0, 2.0, -1.0])
    count = len(wavelengths) - 2
    differences = sum(
        np.eye(count, len(wavelengths), shift) * value for shift, value in enumerate(kernel)
    ) / (np.sqrt(count) * np.linalg.norm(kernel))
    step = wavelengths[1] - wavelengths[0]
    block = palette.smoothness * (SPACING / step) ** 2 * differences
    for part, place in _designed(palette, where):
        del part
        yield _Rows(((place, block),), np.zeros(count))


def _model_errors(palette: Palette, model: FactorModel, where: Unknowns) -> Iterator[_Rows]:
    """The factor model's colours less those of full spectra, for all that a designed one meets (eq. 20)."""
    if not palette.model_error:
        return
    screen = screen_matrix(palette.sensor)
    weight = palette.model_error / np.sqrt(3)
    for material in palette.materials:
        for light in palette.lights:
            if material.samples is None and light.samples is not None:
                seen = model.matrix * model.light(light.samples) @ model.projection
                block, place = screen * light.samples - seen, where.material(material.name)
            elif light.samples is None and material.samples is not None:
                seen = model.matrix * model.reflectance(material.samples) @ model.light_projection
                block, place = screen * material.samples - seen, where.light(light.name)
            else:
                continue
            yield _Rows(((place, weight * block),), np.zeros(3))


def _designed(palette: Palette, where: Unknowns) -> Iterator[tuple[SpectrumSpec, slice]]:
    yield from ((part, where.light(part.name)) for part in palette.lights if part.designed)
    yield from ((part, where.material(part.name)) for part in palette.materials if part.designed)


def _bounds(palette: Palette, where: Unknowns) -> tuple[Array, Array]:
    low, high = np.empty(where.count), np.empty(where.count)
    for name, (least, most) in palette.free.items():
        low[where.free(name)], high[where.free(name)] = least, most
    for part, place in _designed(palette, where):
        low[place], high[place] = part.low, part.high
    return low, high


def undetermined(palette: Palette) -> ColourGoal | None:
    """A wish whose light and material are both to be designed: no linear equation tells it."""
    for wish in palette.goals:
        if palette.material(wish.material).designed and palette.light(wish.light).designed:
            return wish
    return None
