"""How answers move with what they rest on: the colour asked, and the measurements behind the cube."""

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

DRAWS = 3


@dataclass(frozen=True, eq=False)
class Sensitivity:
    """Of a cube; the changes of its atlas are none for a cube without."""

    cube: Cube
    perturbations: list[Perturbation]
    lipschitz: LipschitzConstants
    noise: list[Change]
    reversed: list[Change]
    removed: list[Change]

    @property
    def steepest(self) -> tuple[float, float, float]:
        """Linear RGB of the lowest corner of the steepest cell."""
        cells = self.lipschitz.cells
        red, green, blue = (
            float(self.cube.data.lattice.nodes[place])
            for place in np.unravel_index(int(cells.argmax()), cells.shape)
        )
        return red, green, blue

    def record(self) -> dict[str, Any]:
        """For JSON."""
        steep, boxes = self.lipschitz, self.lipschitz.boxes
        return {
            "moves": [asdict(move) for move in self.perturbations],
            "lipschitz": {
                "largest": steep.largest,
                "median_cell": float(np.median(steep.cells)),
                "largest_per_code": float(steep.codes.max()),
                "median_per_code": float(np.median(steep.codes)),
                "steepest_cell": self.steepest,
                "steepest_wavelength": float(self.cube.data.sensor.wavelengths[steep.waves.argmax()]),
                "largest_box": float(boxes.max()) if boxes.size else None,
            },
            "changes": [changed(change) for change in (*self.noise, *self.reversed, *self.removed)],
        }


def changed(change: Change) -> dict[str, Any]:
    """A change in figures; the radii are those of points that moved by half a ΔE00."""
    known = bool(change.rgb_apart.size)
    return {
        "change": change.what,
        "moved": change.moved,
        "rgb_radius": change.radius(change.rgb_apart) if known else None,
        "lab_radius": change.radius(change.lab_apart) if known else None,
        "delta_e_mean": float(change.delta_e.mean()),
        "delta_e_most": float(change.delta_e.max()),
        "rms_mean": float(change.rms.mean()),
        "rms_most": float(change.rms.max()),
    }


def study_sensitivity(
    cube: Cube,
    atlas: Atlas | None,
    most: int,
    progress: ProgressCallback = ignore_progress,
) -> Sensitivity:
    """Move queries, bound how steep the cube is, and change its ``atlas``: up to ``most`` entries, one at a time.

    ``progress`` hears how many of how many builds are done.

    Raises
    ------
    OptionError : a negative number of entries.
    """
    if most < 0:
        raise OptionError(f"{most} entries cannot be left out", hint="use 0 or more")
    light = observer.light(NARROW_BAND_LIGHT, cube.data.sensor.observer)
    if cube.data.complete_cells is not None:
        problem = (
            "the cube was built for the colours of a scene, and between its cells there is nothing to measure"
        )
        raise OptionError(problem, hint="build it without --scene")
    asked, steep = perturb(cube, light), lipschitz_constants(cube.data)
    if atlas is None or not most:
        return Sensitivity(cube, asked, steep, [], [], [])
    options = dict(cube.data.provenance["options"])
    base = build_baseline(atlas, light, **options | {"lights": tuple(options["lights"])})
    names = base.data.atlas.names[:most]
    jobs = [
        *(partial(add_noise, base, seed) for seed in range(DRAWS)),
        *(partial(reverse_entry, base, name) for name in names),
        *(partial(remove_entry, base, name) for name in names),
    ]
    done = []
    for number, job in enumerate(jobs, 1):
        done.append(job())
        progress(Progress("builds", number, len(jobs)))
    wrong = DRAWS + len(names)
    return Sensitivity(cube, asked, steep, done[:DRAWS], done[DRAWS:wrong], done[wrong:])
