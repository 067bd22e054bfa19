"""Entries that contradict their surroundings. Exact in a small box, they would show as
spots under other lights, and are smoothed (docs/mathematics.md, 8).
"""

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array, Indices, Mask
from uplift.common.errors import UpliftWarning, warn
from uplift.common.text import pluralise
from uplift.fit.gradients import Steps
from uplift.fit.problem import Problem
from uplift.lattice.entry_boxes import EntryBoxes
from uplift.lattice.lattice import CORNERS
from uplift.lattice.point_table import PointTable
from uplift.lookup.interpolate import lattice_spectra
from uplift.pipeline.entries import (
    Constraints,
    MeasuredEntries,
    fit_constraints,
    replaced,
)

SPIKY = "HP1"
"""Light that is added to those of the build: materials of one colour differ most."""
LARGEST_STEP = 0.92
"""ΔE00 by which the step of an 8-bit code between an entry and a face of its box may
exceed the step under the light of the build.
"""
ROUNDS = 3
"""Of finding the share that an entry keeps: the lattice around has steps too."""
DIRECTIONS = np.concatenate([2 * CORNERS - 1, np.eye(3), -np.eye(3)])
"""(14, 3) ramps from an entry: of all channels up or down, and of each."""


def smooth_spots(
    problem: Problem, constraints: Constraints, boxes: EntryBoxes, points: PointTable
) -> tuple[Constraints, dict[str, float]]:
    """Return constraints without spots, and by name the share of their own spectra that
    smoothed entries keep. The rest is the lattice.
    """
    # Looks are wishes for one colour, and not evidence of a material.
    rows = np.flatnonzero(boxes.half_width[: constraints.measured_count] > 0)
    exits, codes = _exits(problem.sensor, boxes, rows)
    known = _are_known(exits, boxes, points)
    rows, exits, codes = rows[known], exits[:, known], codes[:, known]
    sensor = problem.sensor
    own = constraints.spectra(problem.model).reflectance(rows, sensor.wavelengths)
    around = _lattice_spectra(problem, boxes, points, boxes.rgb[rows])
    # Colours are linear in spectra, and so are steps in a box.
    steps = Steps(boxes.lattice, sensor, (sensor.light, *scene_lights(problem)))
    entry, nearby = map(steps.colours, (own, around))
    beyond = np.stack(
        [steps.colours(_lattice_spectra(problem, boxes, points, rgb)) for rgb in exits]
    )
    share = np.ones((len(rows), 1))
    for _ in range(ROUNDS):
        weight = share[..., None]
        excess = _steepest(weight * entry + (1 - weight) * nearby, beyond, codes)
        share /= np.maximum(excess / LARGEST_STEP, 1)[:, None]
    answers = share * own + (1 - share) * around
    spots = share[:, 0] < 1
    rows = rows[spots]
    if not rows.size:
        return constraints, {}
    names = tuple(constraints.names[row] for row in rows)
    goals = MeasuredEntries(names, boxes.rgb[rows], answers[spots])
    smoothed = fit_constraints(problem, constraints.entry_model, goals)
    shares = dict(zip(names, share[spots, 0].tolist(), strict=True))
    return replaced(problem, constraints, rows, smoothed), shares


def scene_lights(problem: Problem) -> tuple[Light, ...]:
    """Return the lights of the build but its own, and `SPIKY`."""
    sensor = problem.sensor
    others = [light for light in problem.lights if light.name != sensor.light.name]
    return (*others, observer.light(SPIKY, sensor.observer, *sensor.range))


def warn_of_spots(shares: dict[str, float]) -> None:
    """Warn of smoothed entries, the least exact first."""
    if not shares:
        return
    names = sorted(shares, key=lambda name: shares[name])
    count = pluralise(len(names), "entry")
    verb = "is" if len(names) == 1 else "are"
    shown = ", ".join(f"'{name}'" for name in names[:3])
    problem = (
        f"{count} {verb} smoothed: exact spectra would show as spots under other "
        f"lights; most of all {shown}"
    )
    hint = "exact_entries=True keeps them"
    warn(UpliftWarning(problem, code="entry-smoothed", hint=hint))


def _are_known(exits: Array, boxes: EntryBoxes, points: PointTable) -> Mask:
    """Whether the nodes that answer exits (D, k, 3) have spectra (k,): all of them,
    unless the cube was built for a scene.
    """
    corners, _ = boxes.lattice.corners(exits.reshape(-1, 3))
    known: Mask = np.all(points.holds(corners).reshape(exits.shape[:2]), axis=0)
    return known


def _exits(sensor: Sensor, boxes: EntryBoxes, rows: Indices) -> tuple[Array, Array]:
    """Linear RGB (D, k, 3) at which ramps through entries (k,), in each of
    `DIRECTIONS`, leave their boxes, and the 8-bit codes (D, k) until there, at least 1.
    """
    codes = np.arange(len(sensor.decoding))
    centre, low, high = (
        np.interp(np.clip(rgb[rows], 0, 1), sensor.decoding, codes)
        for rgb in (boxes.rgb, *boxes.faces)
    )
    ways = DIRECTIONS[:, None]
    room = np.where(ways > 0, high - centre, centre - low)
    count = np.where(ways == 0, np.inf, room).min(axis=-1)
    rgb = np.interp(centre + ways * count[..., None], codes, sensor.decoding)
    return rgb, np.maximum(count, 1)


def _steepest(entry: Array, beyond: Array, codes: Array) -> Array:
    """Largest ΔE00 (k,) of the first and the last step of a code from entries of
    colours (k, L, 3) to those beyond their boxes (D, k, L, 3), less that under the
    first light, of the build.
    """
    step = (beyond - entry) / codes[..., None, None]
    before = np.stack([np.broadcast_to(entry, beyond.shape), beyond - step])
    after = np.stack([entry + step, beyond])
    white = np.ones(3)
    size = delta_e_2000(lab(before, white), lab(after, white))
    excess: Array = size[..., 1:].max(axis=-1) - size[..., 0]
    return excess.max(axis=(0, 1))


def _lattice_spectra(
    problem: Problem, boxes: EntryBoxes, points: PointTable, rgb: Array
) -> Array:
    """Spectra (n, N) that the nodes answer to linear RGB (n, 3) without entries."""
    at = problem.sensor.wavelengths
    return lattice_spectra(problem.model, boxes.lattice, points, rgb, at)
