"""Two cubes compared: where their answers differ, under which lights, and which atlas
entries changed.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.observer import lights as find_lights
from uplift.common.arrays import Array, Indices
from uplift.common.errors import OptionError
from uplift.common.machine import check_memory
from uplift.common.text import pluralise
from uplift.cube.data import CubeData, common_sensor
from uplift.extras.report.measures import delta_e_under, mean_p95_max
from uplift.lookup.blocks import blockwise
from uplift.lookup.cube import Cube

NODES = "nodes"
"""Name of the set of the colours of nodes."""
ENTRIES = "entries"
"""Name of the set of the colours of entries."""
INVISIBLE = 5e-4
"""Largest ΔE00 that is shown as 0.000."""
NODE_BYTES = 200
"""Memory of the comparison of a node."""


@dataclass(frozen=True, eq=False)
class Changes:
    """ΔE00 between the answers of two cubes to a set of colours: nodes, entries, or the
    pixels of an image.
    """

    name: str
    rgb: Array
    """(n, 3) linear RGB."""
    delta_e: Array
    """(n, L) ΔE00 under each light; NaN for colours that a cube lacks."""
    lacking: Indices
    """(n,) which cubes, built for a scene, lack the colour: 0 none, 1 the first, 2 the
    second, 3 both.
    """

    @property
    def largest(self) -> Array:
        """(n,) largest ΔE00 of each colour under any light."""
        return self.delta_e.max(axis=1)

    @property
    def compared(self) -> Array:
        """(m, L) ΔE00 of the colours that both cubes answer."""
        return self.delta_e[self.lacking == 0]

    def worst(self, count: int) -> Indices:
        """Rows of at most ``count`` colours that differ visibly, each once, largest
        ΔE00 first.
        """
        _, rows = np.unique(self.rgb, axis=0, return_index=True)
        order = rows[np.argsort(-self.largest[rows], kind="stable")[:count]]
        return order[self.largest[order] >= INVISIBLE]


@dataclass(frozen=True, eq=False)
class EntryPairs:
    """The entries of two cubes, matched by name, in the RGB space and outside it."""

    names: tuple[str, ...]
    """Entries that both cubes have."""
    rgb: Array
    """(E, 3) their linear RGB in the first cube."""
    spectra: tuple[Array, Array]
    """(E, N) their reflectances in each, at the wavelengths of the first."""
    removed: tuple[str, ...]
    """Entries of the first cube alone."""
    added: tuple[str, ...]
    """Entries of the second cube alone."""


def pair_entries(first: CubeData, second: CubeData) -> EntryPairs:
    """Match the entries of two cubes by name."""
    before = first.atlas.with_outside
    after = second.atlas.with_outside
    rows_before = {name: row for row, name in enumerate(before.names)}
    rows_after = {name: row for row, name in enumerate(after.names)}
    shared = tuple(name for name in rows_before if name in rows_after)
    old = np.array([rows_before[name] for name in shared], dtype=np.int64)
    new = np.array([rows_after[name] for name in shared], dtype=np.int64)
    wavelengths = first.sensor.wavelengths
    return EntryPairs(
        names=shared,
        rgb=before.rgb[old],
        spectra=(
            before.spectra.reflectance(old, wavelengths),
            after.spectra.reflectance(new, wavelengths),
        ),
        removed=tuple(name for name in rows_before if name not in rows_after),
        added=tuple(name for name in rows_after if name not in rows_before),
    )


@dataclass(frozen=True, eq=False)
class CubeDiff:
    """Differences between two cubes of one RGB space, illuminant and observer."""

    names: tuple[str, str]
    cubes: tuple[Cube, Cube]
    lights: tuple[str, ...]
    nodes: Changes
    """Nodes of the lattice of the first cube, then those of the second if it has
    another lattice.
    """
    pairs: EntryPairs
    entries: Changes
    """Spectra of ``pairs``."""
    images: tuple[Changes, ...]

    @property
    def sets(self) -> tuple[Changes, ...]:
        """All sets of colours that were compared."""
        sets = (self.nodes, self.entries, *self.images)
        return tuple(changes for changes in sets if len(changes.rgb))

    @property
    def lacking(self) -> tuple[tuple[str, str, int], ...]:
        """Colours without an answer: their set, the cubes that lack them, and their
        number.
        """
        cubes = ("", *self.names, " and ".join(self.names))
        lacking = []
        for changes in self.sets:
            counts = np.bincount(changes.lacking, minlength=4).tolist()
            for code in (1, 2, 3):
                if counts[code]:
                    lacking.append((changes.name, cubes[code], counts[code]))
        return tuple(lacking)

    @property
    def largest(self) -> float:
        """Largest ΔE00 of all colours under all lights."""
        return float(np.max([row.compared.max(initial=0.0) for row in self.sets]))

    def is_within(self, tolerance: float) -> bool:
        """Whether both cubes have the same entries and colours, and none differs by
        more than ΔE00 ``tolerance``.
        """
        has_same_colours = not any(
            np.isin(changes.lacking, (1, 2)).any() for changes in self.sets
        )
        has_same_entries = not (self.pairs.removed or self.pairs.added)
        return has_same_colours and has_same_entries and self.largest <= tolerance


def diff_cubes(
    cubes: Mapping[str, Cube],
    lights: Sequence[Illuminant],
    images: Mapping[str, Array] | None = None,
) -> CubeDiff:
    """Compare two cubes, by name, at the nodes of both, at their entries, and at the
    colours of images.

    Entries are compared by name, each with the spectrum that the cube has for it, even
    where their colours differ. ``images`` are linear RGB (…, 3) in [0, 1]. Raises
    `OptionError` for cubes of different RGB spaces.
    """
    sensor = common_sensor(cube.data for cube in cubes.values())
    first, second = cubes.values()
    under = find_lights(lights, sensor.observer, sensor.range)

    size = sum(cube.data.lattice.size for cube in cubes.values())
    check_memory(
        size * NODE_BYTES,
        pluralise(size, "node"),
        OptionError,
        "use cubes of a smaller dim",
    )
    nodes, others = (cube.data.lattice.points for cube in (first, second))
    nodes = nodes if np.array_equal(nodes, others) else np.concatenate([nodes, others])
    colours = {
        NODES: nodes,
        **{name: rgb.reshape(-1, 3) for name, rgb in (images or {}).items()},
    }

    def difference(rgb: Array) -> Array:
        answers = [
            cube.reflectance(rgb, sensor.wavelengths) for cube in (first, second)
        ]
        return delta_e_under(under, *answers)

    changes = []
    for name, rgb in colours.items():
        delta_e = np.full((len(rgb), len(under)), np.nan)
        lacking = np.where(first.covers(rgb), 0, 1) + np.where(second.covers(rgb), 0, 2)
        delta_e[lacking == 0] = blockwise(difference, rgb[lacking == 0], len(under))
        changes.append(Changes(name, rgb, delta_e, lacking))

    pairs = pair_entries(first.data, second.data)
    first_name, second_name = cubes
    return CubeDiff(
        names=(first_name, second_name),
        cubes=(first, second),
        lights=tuple(sensor.name for sensor in under),
        nodes=changes[0],
        pairs=pairs,
        entries=Changes(
            ENTRIES,
            pairs.rgb,
            delta_e_under(under, *pairs.spectra),
            np.zeros(len(pairs.names), np.int64),
        ),
        images=tuple(changes[1:]),
    )


def to_json(diff: CubeDiff, tolerance: float | None, worst: int) -> dict[str, object]:
    """Return the figures of a comparison, with the worst colours of each set, for JSON.

    Rows without a difference come last.
    """
    differences = list[dict[str, Any]]()
    worst_colours = list[dict[str, Any]]()
    for changes in diff.sets:
        differences += _differences(changes, diff.lights, tolerance)
        names = diff.pairs.names if changes is diff.entries else None
        for row in changes.worst(worst):
            worst_colours.append(_colour(changes, row, diff.lights, names))
    return {
        "cubes": list(diff.names),
        "largest": diff.largest,
        **(
            {}
            if tolerance is None
            else {"tolerance": tolerance, "passed": diff.is_within(tolerance)}
        ),
        "differences": sorted(differences, key=lambda row: row["max"] < INVISIBLE),
        "worst": worst_colours,
        "entries_removed": list(diff.pairs.removed),
        "entries_added": list(diff.pairs.added),
        "lacking": [
            {"set": name, "cubes": cubes, "colours": count}
            for name, cubes, count in diff.lacking
        ],
    }


def _differences(
    changes: Changes, lights: tuple[str, ...], tolerance: float | None
) -> list[dict[str, Any]]:
    """ΔE00 of a set of colours under each light."""
    rows = []
    for name, delta_e in zip(lights, changes.compared.T, strict=True):
        if delta_e.size:
            row = {"set": changes.name, "light": name, **mean_p95_max(delta_e)}
            if tolerance is not None:
                row["moved"] = int((delta_e > tolerance).sum())
            rows.append(row)
    return rows


def _colour(
    changes: Changes, row: int, lights: tuple[str, ...], names: tuple[str, ...] | None
) -> dict[str, Any]:
    return {
        "set": changes.name,
        **({} if names is None else {"entry": names[row]}),
        "rgb": changes.rgb[row].tolist(),
        "light": lights[changes.delta_e[row].argmax()],
        "delta_e": float(changes.largest[row]),
    }
