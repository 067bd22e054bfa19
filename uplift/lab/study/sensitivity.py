"""Sensitivity of a cube to small changes of the query and of its atlas."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from uplift.atlas import Atlas, Entry
from uplift.atlas.atlas import HIGHEST, LOWEST
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra, rgb_to_lab
from uplift.colorimetry.lights import NARROW_BAND_LIGHT
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.common.errors import OptionError, UpliftWarning
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.cube import CubeData
from uplift.lab.study.lipschitz import LipschitzConstants, lipschitz_constants
from uplift.lookup import MODES, Cube
from uplift.models import reflectance
from uplift.pipeline.build import build
from uplift.pipeline.options import recorded_options

COLOURS = 4096
CONTINUOUS_MODES = tuple(mode for mode in MODES if mode != "nearest")
"""Modes in which answers depend continuously on the query; the nearest node changes abruptly."""
CODE_STEPS = {"1/255": 1.0, "1/1023": 255 / 1023}
"""Steps of one code of 8 and of 10 bits, in 8-bit codes."""
ROUNDING, ROUNDING_STEP = "1e-7", 1e-7
"""Rounding of a float32, in linear RGB."""


@dataclass(frozen=True)
class Perturbation:
    """Changes of the answers of one mode to colours that moved by one step.

    ``_mean`` and ``_most`` are mean and maximum over the colours. The fields are the keys of the JSON output.

    ``mode``: lookup mode.
    ``step``: name of the step.
    ``rms_mean``, ``rms_most``: change of the reflectance, rms over wavelength.
    ``largest``: largest change of reflectance at any wavelength.
    ``light_mean``, ``light_most``: ΔE00 under the light of the study.
    ``own_mean``, ``own_most``: ΔE00 under the illuminant of the cube, which the change of the query itself causes.
    """

    mode: str
    step: str
    rms_mean: float
    rms_most: float
    largest: float
    light_mean: float
    light_most: float
    own_mean: float
    own_most: float


def perturb(cube: Cube, light: Light, count: int = COLOURS) -> list[Perturbation]:
    """Move random colours, uniform in 8-bit codes, by every step and compare the answers.

    Every channel moves up or down, at random, by the full step.
    """
    rng = np.random.default_rng(5)
    codes = rng.uniform(1, 254, (count, 3))
    signs = rng.choice([-1.0, 1.0], (count, 3))
    rgb = cube.decode(codes)
    moved = {name: cube.decode(codes + step * signs) for name, step in CODE_STEPS.items()}
    moved[ROUNDING] = np.clip(rgb + ROUNDING_STEP * signs, 0, 1)
    return [
        _perturbation(cube, light, mode, name, rgb, nearby)
        for mode in CONTINUOUS_MODES
        for name, nearby in moved.items()
    ]


def _perturbation(cube: Cube, light: Light, mode: str, step: str, rgb: Array, nearby: Array) -> Perturbation:
    before, after = (cube.reflectance(colours, mode=mode) for colours in (rgb, nearby))
    change = np.sqrt(((after - before) ** 2).mean(axis=1))
    under_light = delta_e_spectra(light, before, after)
    under_own = delta_e_spectra(cube.data.sensor.light, before, after)
    return Perturbation(
        mode,
        step,
        rms_mean=float(change.mean()),
        rms_most=float(change.max()),
        largest=float(np.abs(after - before).max()),
        light_mean=float(under_light.mean()),
        light_most=float(under_light.max()),
        own_mean=float(under_own.mean()),
        own_most=float(under_own.max()),
    )


NOISE = 0.002
"""Repeatability of a spectrophotometer: standard deviation of a reflectance."""
MOVED_DELTA_E = 0.5
"""ΔE00 above which a lattice point counts as moved: half of a just noticeable difference."""


@dataclass(frozen=True, eq=False)
class Change:
    """Effect of a change of the atlas on the n lattice points.

    ``description``: the change.
    ``rms`` (n,): change of the spectra, rms over wavelength.
    ``delta_e`` (n,): change of the spectra, ΔE00 under a light.
    ``rgb_distance``, ``lab_distance`` (n,): distance in linear RGB and ΔE*ab from the nearer of the old and the new
        colour of the changed entry. Empty if all entries changed.
    """

    description: str
    rms: Array
    delta_e: Array
    rgb_distance: Array
    lab_distance: Array

    @property
    def moved(self) -> float:
        """Share of the lattice points that change by more than `MOVED_DELTA_E`."""
        return float((self.delta_e > MOVED_DELTA_E).mean())

    def radius(self, distance: Array) -> float:
        """Largest distance (n,) of a moved point; 0 if no point moved, NaN if all entries changed."""
        if not distance.size:
            return float("nan")
        return float(np.max(distance[self.delta_e > MOVED_DELTA_E], initial=0))


@dataclass(frozen=True, eq=False)
class Baseline:
    """A cube before its atlas changes.

    ``entries``: entries of the atlas that constrain the cube.
    ``data``: the cube.
    ``spectra`` (n, N): reflectances of the lattice points.
    ``light``: light of all ΔE00.
    ``options``: build options.
    """

    entries: tuple[Entry, ...]
    data: CubeData
    spectra: Array
    light: Light
    options: Mapping[str, Any]


def build_baseline(atlas: Atlas, light: Light, **options: Any) -> Baseline:
    """Build the cube that changes are compared with. Raises `UpliftError`."""
    data = _build_data(atlas.entries, options)
    entries = tuple(entry for entry in atlas.entries if entry.name in data.atlas.names)
    return Baseline(entries, data, _lattice_spectra(data), light, options)


def remove_entry(base: Baseline, name: str) -> Change:
    """Rebuild without an entry."""
    remaining = [entry for entry in base.entries if entry.name != name]
    return _change(base, f"{name} left out", remaining, name)


def reverse_entry(base: Baseline, name: str) -> Change:
    """Rebuild with the wavelengths of an entry in reverse order, as an example of a wrong measurement."""
    entries = [replace(entry, values=entry.values[::-1]) if entry.name == name else entry for entry in base.entries]
    return _change(base, f"{name} wrong", entries, name)


def add_noise(base: Baseline, seed: int) -> Change:
    """Rebuild with `NOISE` added to every entry."""
    rng = np.random.default_rng(seed)

    def noisy(entry: Entry) -> Entry:
        values = entry.values + rng.normal(0, NOISE, len(entry.values))
        return replace(entry, values=np.clip(values, LOWEST, HIGHEST))

    return _change(base, f"noise, draw {seed}", [noisy(entry) for entry in base.entries])


def _change(base: Baseline, description: str, entries: Sequence[Entry], name: str | None = None) -> Change:
    data = _build_data(entries, base.options)
    after = _lattice_spectra(data)
    rms = np.sqrt(((after - base.spectra) ** 2).mean(axis=1))
    colours = [each.atlas.rgb[each.atlas.names.index(name)] for each in (base.data, data) if name in each.atlas.names]
    points, sensor = base.data.lattice.points, base.data.sensor
    return Change(
        description,
        rms,
        delta_e_spectra(base.light, base.spectra, after),
        _distance(points, colours),
        _distance(rgb_to_lab(sensor, points), [rgb_to_lab(sensor, colour) for colour in colours]),
    )


def _distance(points: Array, centres: Sequence[Array]) -> Array:
    """Distance (n,) of points (n, 3) to the nearest centre; empty without centres."""
    if not centres:
        return np.zeros(0)
    return np.asarray(np.min([np.linalg.norm(points - centre, axis=1) for centre in centres], axis=0))


def _build_data(entries: Sequence[Entry], options: Mapping[str, Any]) -> CubeData:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        return build(Atlas(tuple(entries)), **options).data


def _lattice_spectra(data: CubeData) -> Array:
    return reflectance(data.model, data.points.coefficients, data.sensor.wavelengths)


NOISE_DRAWS = 3


@dataclass(frozen=True, eq=False)
class Sensitivity:
    """Results of `study_sensitivity`.

    ``cube``: the cube.
    ``perturbations``: changes of the query.
    ``lipschitz``: lipschitz constants of the cube.
    ``noise``, ``reversed``, ``removed``: changes of the atlas: noise on all entries, one entry reversed, one entry
        removed. Empty without an atlas.
    """

    cube: Cube
    perturbations: list[Perturbation]
    lipschitz: LipschitzConstants
    noise: list[Change]
    reversed: list[Change]
    removed: list[Change]

    @property
    def steepest(self) -> tuple[float, float, float]:
        """Linear RGB of the lowest corner of the cell with the largest Lipschitz constant."""
        cells, nodes = self.lipschitz.cells, self.cube.data.lattice.nodes
        red, green, blue = (float(nodes[index]) for index in np.unravel_index(int(cells.argmax()), cells.shape))
        return red, green, blue

    @property
    def moved_cells(self) -> int:
        """Number of cells in which mode ``spectra`` moves mixtures to exact colours; the constants are of mixtures."""
        data = self.cube.data
        if data.inexact_cells is None:
            return 0
        return int(data.inexact_cells.reshape((data.lattice.dim,) * 3)[:-1, :-1, :-1].sum())

    def record(self) -> dict[str, Any]:
        """Convert to JSON values."""
        constants, boxes = self.lipschitz, self.lipschitz.boxes
        steepest_wavelength = self.cube.data.sensor.wavelengths[constants.wavelengths.argmax()]
        return {
            "moves": [asdict(each) for each in self.perturbations],
            "lipschitz": {
                "largest": constants.largest,
                "median_cell": float(np.median(constants.cells)),
                "largest_per_code": float(constants.codes.max()),
                "median_per_code": float(np.median(constants.codes)),
                "steepest_cell": self.steepest,
                "steepest_wavelength": float(steepest_wavelength),
                "largest_box": float(boxes.max()) if boxes.size else None,
                "moved_cells": self.moved_cells,
            },
            "changes": [change_record(each) for each in (*self.noise, *self.reversed, *self.removed)],
        }


def change_record(change: Change) -> dict[str, Any]:
    """Convert a change to JSON values."""
    one_entry = bool(change.rgb_distance.size)
    return {
        "change": change.description,
        "moved": change.moved,
        "rgb_radius": change.radius(change.rgb_distance) if one_entry else None,
        "lab_radius": change.radius(change.lab_distance) if one_entry else None,
        "delta_e_mean": float(change.delta_e.mean()),
        "delta_e_most": float(change.delta_e.max()),
        "rms_mean": float(change.rms.mean()),
        "rms_most": float(change.rms.max()),
    }


def study_sensitivity(
    cube: Cube,
    atlas: Atlas | None,
    entries: int,
    progress: ProgressCallback = ignore_progress,
) -> Sensitivity:
    """Perturb queries, compute Lipschitz constants, and rebuild the cube with changes of its atlas.

    Raises `OptionError`.
    """
    if entries < 0:
        raise OptionError(
            f"entries must be at least 0, got {entries}",
            code="entries-out-of-range",
            hint="give 0 to change no entry",
        )
    if cube.data.complete_cells is not None:
        raise OptionError(
            "a sparse cube has no answers between the cells of its scene",
            code="sparse-cube",
            hint="build it without a scene",
        )
    light = observer.light(NARROW_BAND_LIGHT, cube.data.sensor.observer)
    perturbations, lipschitz = perturb(cube, light), lipschitz_constants(cube.data)
    if atlas is None or not entries:
        return Sensitivity(cube, perturbations, lipschitz, [], [], [])
    base = build_baseline(atlas, light, **recorded_options(cube.data.provenance["options"]))
    names = base.data.atlas.names[:entries]
    jobs = [
        *(partial(add_noise, base, seed) for seed in range(NOISE_DRAWS)),
        *(partial(reverse_entry, base, name) for name in names),
        *(partial(remove_entry, base, name) for name in names),
    ]
    changes = []
    for number, job in enumerate(jobs, 1):
        changes.append(job())
        progress(Progress("builds", number, len(jobs)))
    first_removed = NOISE_DRAWS + len(names)
    noise, reverse, removed = (
        changes[:NOISE_DRAWS],
        changes[NOISE_DRAWS:first_removed],
        changes[first_removed:],
    )
    return Sensitivity(cube, perturbations, lipschitz, noise, reverse, removed)
