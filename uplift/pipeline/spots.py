"""Entries that contradict their surroundings. Exact in a small box, they would show as
spots under other lights, and are smoothed (docs/mathematics.md, 8).
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array, Indices, Mask
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
LARGEST_STEP = 0.92
"""ΔE00 by which the step of an 8-bit code between an entry and a face of its box may
exceed the step under the light of the build.
"""
ROUNDS = 3
"""Of finding the share that an entry keeps: the lattice around has steps too."""
DIRECTIONS = np.concatenate([2 * CORNERS - 1, np.eye(3), -np.eye(3)])
"""(14, 3) ramps from an entry: of all channels up or down, and of each."""


class Exit(NamedTuple):
    """Where ramps leave the boxes of k entries."""

    rgb: Array
    """(k, 3) linear RGB."""
    codes: Array
    """(k, 1) 8-bit codes from the entry, at least 1."""


def smooth_spots(
    problem: Problem, constraints: Constraints, boxes: EntryBoxes, points: PointTable
) -> tuple[Constraints, dict[str, float]]:
    """Return constraints without spots, and by name the share of their own spectra that
    smoothed entries keep. The rest is the lattice.
    """
    # Looks are wishes for one colour, and not evidence of a material.
    rows = np.flatnonzero(boxes.half_width[: constraints.measured_count] > 0)
    exits = _exits(problem.sensor, boxes, rows)
    known = _are_known(exits, boxes, points)
    rows = rows[known]
    exits = [Exit(place.rgb[known], place.codes[known]) for place in exits]
    spectra = constraints.spectra(problem.model)
    own = spectra.reflectance(rows, problem.sensor.wavelengths)
    around = _lattice_spectra(problem, boxes, points, boxes.rgb[rows])
    reached = [_lattice_spectra(problem, boxes, points, place.rgb) for place in exits]
    answers, share = own, np.ones((len(rows), 1))
    for _ in range(ROUNDS):
        steps = _steepest(problem, answers, exits, reached)
        share /= np.maximum(steps / LARGEST_STEP, 1)[:, None]
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


def _are_known(exits: Sequence[Exit], boxes: EntryBoxes, points: PointTable) -> Mask:
    """Whether the nodes that the boxes of entries need have spectra (k,): all of them,
    unless the cube was built for a scene.
    """
    corners = [boxes.lattice.corners(place.rgb)[0] for place in exits]
    return points.holds(np.concatenate(corners, axis=1))


def _exits(sensor: Sensor, boxes: EntryBoxes, rows: Indices) -> list[Exit]:
    """Where ramps through entries (k,) in each of `DIRECTIONS` leave their boxes."""
    codes = np.arange(len(sensor.decoding))
    centre, low, high = (
        np.interp(np.clip(rgb[rows], 0, 1), sensor.decoding, codes)
        for rgb in (boxes.rgb, *boxes.faces)
    )
    exits = []
    for direction in DIRECTIONS:
        room = np.where(direction > 0, high - centre, centre - low)
        count = np.where(direction == 0, np.inf, room).min(axis=1)[:, None]
        rgb = np.interp(centre + direction * count, codes, sensor.decoding)
        exits.append(Exit(rgb, np.maximum(count, 1)))
    return exits


def _steepest(
    problem: Problem, own: Array, exits: Sequence[Exit], answers: Sequence[Array]
) -> Array:
    """Largest ΔE00 (k,) of the step of a code between entries with spectra (k, N) and
    those of the lattice at exits, less that under the light of the build.
    """
    steepest = np.zeros(len(own))
    lights = scene_lights(problem)
    for place, answer in zip(exits, answers, strict=True):
        # Mixtures are linear on the way: the first step is like all, and the last.
        step = (answer - own) / place.codes
        for before, after in ((own, own + step), (answer - step, answer)):
            expected = delta_e_spectra(problem.sensor.light, before, after)
            for light in lights:
                excess = delta_e_spectra(light, before, after) - expected
                steepest = np.maximum(steepest, excess)
    return steepest


def _lattice_spectra(
    problem: Problem, boxes: EntryBoxes, points: PointTable, rgb: Array
) -> Array:
    """Spectra (n, N) that the nodes answer to linear RGB (n, 3) without entries."""
    at = problem.sensor.wavelengths
    return lattice_spectra(problem.model, boxes.lattice, points, rgb, at)
