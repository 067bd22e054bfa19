"""Entries that contradict their surroundings. Exact in a small box, they would show as
spots under other lights, and are smoothed (docs/mathematics.md, 8).
"""

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array, Indices
from uplift.common.errors import UpliftWarning, warn
from uplift.common.text import pluralise
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
LARGEST_STEP = 0.8
"""ΔE00 by which the step of an 8-bit code between an entry and a face of its box may
exceed the step under the light of the build.
"""
DIRECTIONS = np.concatenate([2 * CORNERS - 1, np.eye(3), -np.eye(3)])
"""(14, 3) from an entry to the corners and the faces of its box."""


def smooth_spots(
    problem: Problem, constraints: Constraints, boxes: EntryBoxes, points: PointTable
) -> tuple[Constraints, dict[str, float]]:
    """Return constraints without spots, and by name the share of their own spectra that
    smoothed entries keep. The rest is the lattice.
    """
    # Looks are wishes for one colour, and not evidence of a material.
    rows = np.flatnonzero(boxes.half_width[: constraints.measured_count] > 0)
    rows = rows[_are_known(boxes, points, rows)]
    steps = _steepest(problem, constraints, boxes, points, rows)
    spots = steps > LARGEST_STEP
    rows = rows[spots]
    if not rows.size:
        return constraints, {}
    share = LARGEST_STEP / steps[spots]
    weight = share[:, None]
    own = _own_spectra(problem, constraints, rows)
    around = _lattice_spectra(problem, boxes, points, boxes.rgb[rows])
    names = tuple(constraints.names[row] for row in rows)
    goals = MeasuredEntries(
        names, boxes.rgb[rows], weight * own + (1 - weight) * around
    )
    smoothed = fit_constraints(problem, constraints.entry_model, goals)
    shares = dict(zip(names, share.tolist(), strict=True))
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


def _own_spectra(problem: Problem, constraints: Constraints, rows: Indices) -> Array:
    """Spectra (k, N) that answer the colours of entries (k,)."""
    spectra = constraints.spectra(problem.model)
    return spectra.reflectance(rows, problem.sensor.wavelengths)


def _are_known(boxes: EntryBoxes, points: PointTable, rows: Indices) -> Array:
    """Whether the nodes that the boxes of entries (k,) need have spectra: all of them,
    unless the cube was built for a scene.
    """
    known = np.ones(len(rows), dtype=bool)
    if not points.present.all():
        for exit_rgb in _exits(boxes, rows):
            corners, _ = boxes.lattice.corners(exit_rgb)
            known &= points.holds(corners)
    return known


def _exits(boxes: EntryBoxes, rows: Indices) -> list[Array]:
    """Linear RGB (k, 3) at which boxes are left in each of `DIRECTIONS`."""
    low, high = (np.clip(face[rows], 0, 1) for face in boxes.faces)
    centre = boxes.rgb[rows]
    return [
        np.where(direction > 0, high, np.where(direction < 0, low, centre))
        for direction in DIRECTIONS
    ]


def _steepest(
    problem: Problem,
    constraints: Constraints,
    boxes: EntryBoxes,
    points: PointTable,
    rows: Indices,
) -> Array:
    """Largest ΔE00 (k,) of the step of a code in the boxes of entries, less that under
    the light of the build.
    """
    sensor = problem.sensor
    own = _own_spectra(problem, constraints, rows)
    codes = np.arange(len(sensor.decoding))
    centre = np.interp(boxes.rgb[rows], sensor.decoding, codes)
    steepest = np.zeros(len(rows))
    lights = scene_lights(problem)
    for exit_rgb in _exits(boxes, rows):
        passed = np.abs(np.interp(exit_rgb, sensor.decoding, codes) - centre)
        count = np.maximum(passed.max(axis=1), 1)
        answers = _lattice_spectra(problem, boxes, points, exit_rgb)
        expected = delta_e_spectra(sensor.light, own, answers)
        for light in lights:
            excess = delta_e_spectra(light, own, answers) - expected
            steepest = np.maximum(steepest, excess / count)
    return steepest


def _lattice_spectra(
    problem: Problem, boxes: EntryBoxes, points: PointTable, rgb: Array
) -> Array:
    """Spectra (n, N) that the nodes answer to linear RGB (n, 3) without entries."""
    at = problem.sensor.wavelengths
    return lattice_spectra(problem.model, boxes.lattice, points, rgb, at)
