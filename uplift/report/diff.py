"""Two cubes compared: where their answers differ, under which lights, and which atlas entries changed."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.observer import light
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array, Indices
from uplift.lookup import Cube
from uplift.lookup.cube import common_sensor

BLOCK = 1 << 14
"""Colours whose spectra are in memory at once."""
NODES, ENTRIES = "nodes", "entries"
"""Names of the sets of colours that come from the cubes."""


@dataclass(frozen=True, eq=False)
class Changes:
    """ΔE00 between the answers of two cubes to a set of colours: nodes, entries, or the pixels of an image."""

    name: str
    rgb: Array
    """(n, 3) linear RGB."""
    delta_e: Array
    """(L, n) ΔE00 under each light."""

    @property
    def largest(self) -> Array:
        """(n,) largest ΔE00 of each colour under any light."""
        return np.asarray(self.delta_e.max(axis=0, initial=0.0))

    def worst(self, count: int) -> Indices:
        """Rows of at most ``count`` colours that differ, each once, largest ΔE00 first."""
        _, rows = np.unique(self.rgb, axis=0, return_index=True)
        order = rows[np.argsort(-self.largest[rows], kind="stable")[:count]]
        return order[self.largest[order] > 0]


@dataclass(frozen=True, eq=False)
class CubeDiff:
    """Differences between two cubes of one RGB space, illuminant and observer."""

    names: tuple[str, str]
    cubes: tuple[Cube, Cube]
    lights: tuple[str, ...]
    nodes: Changes
    """Nodes of the lattice of the first cube, then those of the second if it has another lattice."""
    entries: Changes
    """Spectra of the entries that both cubes have, in the order of `entry_names`."""
    images: tuple[Changes, ...]
    entry_names: tuple[str, ...]
    removed: tuple[str, ...]
    """Entries of the first cube alone."""
    added: tuple[str, ...]
    """Entries of the second cube alone."""
    uncovered: int
    """Colours that one of the cubes lacks, because it was built for a scene. Their difference counts as 0."""

    @property
    def sets(self) -> tuple[Changes, ...]:
        """All sets of colours that were compared."""
        return tuple(each for each in (self.nodes, self.entries, *self.images) if len(each.rgb))

    @property
    def largest(self) -> float:
        """Largest ΔE00 of all colours under all lights."""
        return max(float(each.largest.max()) for each in self.sets)

    def is_within(self, tolerance: float) -> bool:
        """Whether both cubes have the same entries, and no colour differs by more than ΔE00 ``tolerance``."""
        return not self.removed and not self.added and self.largest <= tolerance


def diff_cubes(cubes: Mapping[str, Cube], lights: Sequence[str], images: Mapping[str, Array] | None = None) -> CubeDiff:
    """Compare two cubes, by name, at the nodes of both, at their entries, and at the colours of images.

    Entries are compared by name, each with the spectrum that the cube has for it, even where their colours differ.
    ``images`` are linear RGB (…, 3) in [0, 1]. Raises `OptionError` for cubes of different RGB spaces.
    """
    sensor = common_sensor(cubes.values())
    first, second = cubes.values()
    under = [light(name, sensor.observer, *sensor.range) for name in lights]

    nodes, others = (cube.data.lattice.points for cube in (first, second))
    nodes = nodes if np.array_equal(nodes, others) else np.concatenate([nodes, others])
    colours = {NODES: nodes, **{name: rgb.reshape(-1, 3) for name, rgb in (images or {}).items()}}
    covered = {name: first.covers(rgb) & second.covers(rgb) for name, rgb in colours.items()}
    changes = []
    for name, rgb in colours.items():
        delta_e = np.zeros((len(under), len(rgb)))
        rows = np.flatnonzero(covered[name])
        for begin in range(0, len(rows), BLOCK):
            block = rows[begin : begin + BLOCK]
            answers = [cube.reflectance(rgb[block], sensor.wavelengths) for cube in (first, second)]
            delta_e[:, block] = _delta_e(under, *answers)
        changes.append(Changes(name, rgb, delta_e))

    rows_of = [{name: row for row, name in enumerate(cube.data.atlas.names)} for cube in (first, second)]
    shared = tuple(name for name in rows_of[0] if name in rows_of[1])
    entries = [np.array([each[name] for name in shared], dtype=np.int64) for each in rows_of]
    spectra = [
        cube.data.entry_spectra.reflectance(found, sensor.wavelengths)
        for cube, found in zip((first, second), entries, strict=True)
    ]
    first_name, second_name = cubes
    return CubeDiff(
        names=(first_name, second_name),
        cubes=(first, second),
        lights=tuple(each.name for each in under),
        nodes=changes[0],
        entries=Changes(ENTRIES, first.data.atlas.rgb[entries[0]], _delta_e(under, *spectra)),
        images=tuple(changes[1:]),
        entry_names=shared,
        removed=tuple(name for name in rows_of[0] if name not in rows_of[1]),
        added=tuple(name for name in rows_of[1] if name not in rows_of[0]),
        uncovered=sum(int((~mask).sum()) for mask in covered.values()),
    )


def _delta_e(lights: Sequence[Light], first: Array, second: Array) -> Array:
    """ΔE00 (L, n) under lights between reflectances (n, N)."""
    return np.array([delta_e_spectra(light, first, second) for light in lights]).reshape(len(lights), len(first))


def to_json(diff: CubeDiff, tolerance: float | None, worst: int) -> dict[str, object]:
    """Return the figures of a comparison, with the worst colours of each set, for JSON."""
    return {
        "cubes": list(diff.names),
        "largest": diff.largest,
        **({} if tolerance is None else {"tolerance": tolerance, "passed": diff.is_within(tolerance)}),
        "differences": [
            {
                "set": each.name,
                "light": name,
                "mean": float(values.mean()),
                "p95": float(np.quantile(values, 0.95)),
                "max": float(values.max()),
                **({} if tolerance is None else {"moved": int((values > tolerance).sum())}),
            }
            for each in diff.sets
            for name, values in zip(diff.lights, each.delta_e, strict=True)
        ],
        "worst": [
            {
                "set": each.name,
                **({"entry": diff.entry_names[row]} if each is diff.entries else {}),
                "rgb": each.rgb[row].tolist(),
                "light": diff.lights[each.delta_e[:, row].argmax()],
                "delta_e": float(each.largest[row]),
            }
            for each in diff.sets
            for row in each.worst(worst)
        ],
        "entries_removed": list(diff.removed),
        "entries_added": list(diff.added),
        "uncovered": diff.uncovered,
    }
