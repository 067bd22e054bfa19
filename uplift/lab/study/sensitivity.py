"""Sensitivity of a cube to the query and to the measurements behind it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

import numpy as np

from uplift.atlas import Atlas
from uplift.colorimetry import observer
from uplift.colorimetry.lights import NARROW_BAND_LIGHT
from uplift.common.errors import OptionError
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.lab.study.input_noise import Perturbation, perturb
from uplift.lab.study.lipschitz import LipschitzConstants, lipschitz_constants
from uplift.lab.study.locality import Change, add_noise, build_baseline, remove_entry, reverse_entry
from uplift.lookup import Cube
from uplift.pipeline.options import recorded_options

__all__ = ["Sensitivity", "change_record", "study_sensitivity"]

NOISE_DRAWS = 3


@dataclass(frozen=True, eq=False)
class Sensitivity:
    """Results of `study_sensitivity`.

    Parameters
    ----------
    cube : Cube
        The cube.
    perturbations : list of Perturbation
        Changes of the query.
    lipschitz : LipschitzConstants
        Lipschitz constants of the cube.
    noise, reversed, removed : list of Change
        Changes of the atlas: noise on all entries, one entry reversed, one entry removed. Empty without an atlas.
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
        """Convert to JSON values.

        Returns
        -------
        dict
            Keys ``moves``, ``lipschitz`` and ``changes``.
        """
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
    """Convert a change to JSON values.

    Parameters
    ----------
    change : Change
        The change.

    Returns
    -------
    dict
        Numbers by name. Radii are those of points that moved by more than half a ΔE00.
    """
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

    Parameters
    ----------
    cube : Cube
        A cube with a complete lattice.
    atlas : Atlas or None
        The atlas that the cube was built from, if any.
    entries : int
        Largest number of entries that are changed, one at a time, at least 0.
    progress : callable, optional
        Called with the stage ``"builds"``.

    Returns
    -------
    Sensitivity
        The results.

    Raises
    ------
    OptionError
        ``entries`` is negative, or the cube is sparse.
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
