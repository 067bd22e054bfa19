"""Sensitivity of a cube to small changes of the query and of its atlas."""

import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.spatial.distance import cdist

from uplift.atlas.atlas import HIGHEST, LOWEST, Atlas, Entry
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra, rgb_to_lab
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.common.errors import OptionError, UpliftWarning
from uplift.common.progress import ProgressCallback, ignore_progress, reported
from uplift.cube.data import CubeData
from uplift.extras.colour.light_sets import NARROW_BAND_LIGHT
from uplift.extras.report.comparison import compare_spectra
from uplift.lab.runner import Row
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import MODES
from uplift.models.model import reflectance
from uplift.pipeline.build import build
from uplift.pipeline.options import recorded_options

COLOURS = 4096
CONTINUOUS_MODES = tuple(mode for mode in MODES if mode != "nearest")
"""Modes in which answers depend continuously on the query; the nearest node changes
abruptly.
"""
CODE_STEPS = {"1/255": 1.0, "1/1023": 255 / 1023}
"""Steps of one code of 8 and of 10 bits, in 8-bit codes."""
NOISE = 0.002
"""Repeatability of a spectrophotometer: standard deviation of a reflectance."""
HALVINGS = 16
"""Halvings of a step, after which that of an 8-bit code is rounding."""
HALVED = 16
"""Number of colours whose steps are halved."""
MOVED_DELTA_E = 0.5
"""ΔE00 above which a node counts as moved: half of a just noticeable difference."""
Answer = Callable[[Array], Array]
"""From linear RGB (n, 3) to reflectances (n, N), or from 8-bit codes to linear RGB."""


@dataclass(frozen=True, eq=False)
class Change:
    """Effect of a change of the atlas on n nodes.

    ``rms`` (n,): change of the spectra, rms over wavelength. ``delta_e`` (n,): the
    same, ΔE00 under a light. ``distance`` (2, n): in linear RGB and in ΔE*ab from the
    nearer of the old and the new colour of the changed entry; None if all entries
    changed.
    """

    description: str
    rms: Array
    delta_e: Array
    distance: Array | None

    def row(self) -> Row:
        """Summarise the change: the share of nodes that move by more than
        `MOVED_DELTA_E`, their largest distances, 0 if none moved, and statistics.
        """
        moved = self.delta_e > MOVED_DELTA_E
        radii = [None, None]
        if self.distance is not None:
            radii = self.distance[:, moved].max(axis=1, initial=0).tolist()
        return {
            "change": self.description,
            "moved": float(moved.mean()),
            "rgb_radius": radii[0],
            "lab_radius": radii[1],
            **mean_and_most("delta_e", self.delta_e),
            **mean_and_most("rms", self.rms),
        }


def mean_and_most(name: str, errors: Array) -> dict[str, float]:
    """Return the mean and the largest of errors, with their names in tables."""
    return {f"{name}_mean": float(errors.mean()), f"{name}_most": float(errors.max())}


def comparison_light(data: CubeData) -> Light:
    """Return the light under which answers of a cube are compared."""
    sensor = data.sensor
    return observer.light(NARROW_BAND_LIGHT, sensor.observer, *sensor.range)


def perturb_atlas(
    data: CubeData,
    atlas: Atlas,
    count: int,
    progress: ProgressCallback = ignore_progress,
) -> list[Change]:
    """Rebuild a cube with changes of its atlas, ``count`` entries one at a time."""
    options = recorded_options(data.provenance["options"])
    light = comparison_light(data)
    changes = []
    with warnings.catch_warnings(action="ignore", category=UpliftWarning):
        before = build(atlas, **options).data
        kept = [entry for entry in atlas if entry.name in before.atlas.names]
        jobs = list(changed_atlases(kept, before.atlas.names[:count]))
        for description, name, changed in reported(jobs, "builds", progress):
            after = build(Atlas(tuple(changed)), **options).data
            changes.append(compare(before, after, light, description, name))
    return changes


def perturb(cube: Cube, count: int = COLOURS) -> list[Row]:
    """Perturb the queries of every mode of a cube. Raises `OptionError`."""
    data = cube.data
    if data.is_sparse:
        problem = "a sparse cube has no answers between the cells of its scene"
        raise OptionError(problem, code="sparse-cube", hint="build it without a scene")
    lights = comparison_light(data), data.sensor.light
    rows: list[Row] = []
    for mode in CONTINUOUS_MODES:
        answer = partial(cube.reflectance, mode=mode)
        rows += perturb_answers(mode, answer, cube.decode, lights, count)
    return rows


def perturb_answers(
    mode: str,
    answer: Answer,
    decode: Answer,
    lights: tuple[Light, Light],
    count: int = COLOURS,
) -> list[Row]:
    """Move random colours, uniform in 8-bit codes, by every step and compare the
    answers; of two lights the second one defines the RGB.

    Every channel moves up or down, at random, by the full step. ``rms`` is the change
    of the reflectance over wavelength, ``largest`` that at any wavelength; ``light``
    and ``own`` are ΔE00 under the lights; the change of the query causes that of
    ``own``. ``_mean`` and ``_most`` are over the colours. ``jump`` is the largest ΔE00
    under the first light that remains when steps are halved: 0 but for rounding, unless
    answers jump.
    """
    rng = np.random.default_rng(5)
    codes = rng.uniform(1, 254, (count, 3))
    signs = rng.choice([-1.0, 1.0], (count, 3))
    rgb = decode(codes)
    moved = {name: decode(codes + step * signs) for name, step in CODE_STEPS.items()}
    moved["1e-7"] = np.clip(rgb + 1e-7 * signs, 0, 1)  # rounding of a float32
    before = answer(rgb)
    rows = []
    for step, colours in moved.items():
        after = answer(colours)
        found = compare_spectra(before, after, lights)
        light, own = found.delta_e.T
        largest = np.argsort(light)[-HALVED:]
        ends = rgb[largest], colours[largest]
        rows.append(
            {
                "mode": mode,
                "step": step,
                **mean_and_most("rms", found.rms),
                "largest": float(found.deviation.max()),
                **mean_and_most("light", light),
                **mean_and_most("own", own),
                "jump": _largest_jump(answer, lights[0], *ends),
            }
        )
    return rows


def _largest_jump(answer: Answer, light: Light, first: Array, second: Array) -> float:
    """Halve the steps between colours (n, 3), keep the halves with the larger ΔE00, and
    return the largest one left.
    """
    for _ in range(HALVINGS):
        middle = (first + second) / 2
        before, between, after = map(answer, (first, middle, second))
        below = delta_e_spectra(light, before, between)
        above = delta_e_spectra(light, between, after)
        is_first = (below > above)[:, None]
        first = np.where(is_first, first, middle)
        second = np.where(is_first, middle, second)
    return float(delta_e_spectra(light, answer(first), answer(second)).max())


def changed_atlases(
    entries: Sequence[Entry], names: Sequence[str]
) -> Iterator[tuple[str, str, list[Entry]]]:
    """Yield descriptions of changes, the changed entry, empty if all changed, and all
    entries.

    Changes are `NOISE` on all entries, an entry with its wavelengths in reverse order,
    as an example of a wrong measurement, and an entry left out.
    """
    for seed in range(3):
        rng = np.random.default_rng(seed)
        noisy = []
        for entry in entries:
            values = entry.values + rng.normal(0, NOISE, len(entry.values))
            noisy.append(replace(entry, values=np.clip(values, LOWEST, HIGHEST)))
        yield f"noise, draw {seed}", "", noisy
    for name in names:
        reverse = [
            replace(entry, values=entry.values[::-1]) if entry.name == name else entry
            for entry in entries
        ]
        yield f"{name} wrong", name, reverse
    for name in names:
        others = [entry for entry in entries if entry.name != name]
        yield f"{name} left out", name, others


def node_spectra(data: CubeData) -> Array:
    """Return the reflectances (n, N) of the nodes of a cube."""
    return reflectance(data.model, data.points.coefficients, data.sensor.wavelengths)


def compare(
    before: CubeData, after: CubeData, light: Light, description: str, name: str
) -> Change:
    """Compare the nodes of a cube with those after a change of its atlas, of all
    entries or of a named one.
    """
    found = compare_spectra(node_spectra(before), node_spectra(after), [light])
    distance = None
    if name:
        rgb = [
            atlas.rgb[atlas.names.index(name)]
            for atlas in (before.atlas, after.atlas)
            if name in atlas.names
        ]
        colours = (before.lattice.points, np.array(rgb))
        labs = [rgb_to_lab(before.sensor, colour) for colour in colours]
        distance = np.array([cdist(*pair).min(axis=1) for pair in (colours, labs)])
    return Change(description, found.rms, found.delta_e[:, 0], distance)
