"""Two cubes compared: where their answers differ, under which lights, and which atlas
entries changed.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.observer import lights as find_lights
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array, Indices
from uplift.common.errors import OptionError
from uplift.common.machine import check_memory
from uplift.common.text import pluralise
from uplift.cube.data import CubeData, common_sensor
from uplift.extras.report.comparison import Comparison, delta_e_under
from uplift.lookup.blocks import blockwise
from uplift.lookup.cube import Cube

INVISIBLE = 5e-4
"""Largest ΔE00 that is shown as 0.000."""
NODE_BYTES = 200
"""Memory of the comparison of a node."""


@dataclass(frozen=True, eq=False)
class Changes(Comparison):
    """Differences between the answers of two cubes to a set of colours: nodes, entries,
    or the pixels of an image.
    """

    set: str
    rgb: Array
    """(n, 3) linear RGB."""
    lacking: Indices
    """(n,) which cubes, built for a scene, lack the colour: 0 none, 1 the first, 2 the
    second, 3 both.
    """
    names: tuple[str, ...] = ()
    """Names of the colours, of entries alone."""

    def worst_rows(self, count: int) -> Indices:
        """Return rows of at most ``count`` colours that differ visibly, each once,
        largest ΔE00 first.
        """
        _, rows = np.unique(self.rgb, axis=0, return_index=True)
        order = rows[np.argsort(-self.worst[rows], kind="stable")[:count]]
        return order[self.worst[order] >= INVISIBLE]

    def describe(self, row: int) -> dict[str, Any]:
        """Return the figures of a colour for JSON."""
        return {
            "set": self.set,
            **({"entry": self.names[row]} if self.names else {}),
            "rgb": self.rgb[row].tolist(),
            "light": self.worst_light(row),
            "delta_e": float(self.worst[row]),
        }


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
    old_rows = {name: row for row, name in enumerate(before.names)}
    new_rows = {name: row for row, name in enumerate(after.names)}
    shared = tuple(name for name in old_rows if name in new_rows)
    old = np.array([old_rows[name] for name in shared], dtype=np.int64)
    new = np.array([new_rows[name] for name in shared], dtype=np.int64)
    at = first.sensor.wavelengths
    return EntryPairs(
        names=shared,
        rgb=before.rgb[old],
        spectra=(
            before.spectra.reflectance(old, at),
            after.spectra.reflectance(new, at),
        ),
        removed=tuple(name for name in old_rows if name not in new_rows),
        added=tuple(name for name in new_rows if name not in old_rows),
    )


@dataclass(frozen=True, eq=False)
class CubeDiff:
    """Differences between two cubes of one RGB space, illuminant and observer."""

    names: tuple[str, str]
    cubes: tuple[Cube, Cube]
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
    def lacking(self) -> list[dict[str, Any]]:
        """Colours without an answer: their set, the cubes that lack them, and their
        number.
        """
        cubes = ("", *self.names, " and ".join(self.names))
        lacking = []
        for changes in self.sets:
            counts = np.bincount(changes.lacking, minlength=4).tolist()
            for code in (1, 2, 3):
                if counts[code]:
                    row = {"cubes": cubes[code], "colours": counts[code]}
                    lacking.append({"set": changes.set, **row})
        return lacking

    @property
    def largest(self) -> float:
        """Largest ΔE00 of all colours under all lights."""
        return max(changes.largest for changes in self.sets)

    def is_within(self, tolerance: float) -> bool:
        """Whether both cubes have the same entries and colours, and none differs by
        more than ΔE00 ``tolerance``.
        """
        lacks = [np.isin(changes.lacking, (1, 2)).any() for changes in self.sets]
        is_same = not (any(lacks) or self.pairs.removed or self.pairs.added)
        return is_same and self.largest <= tolerance


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
    if not np.array_equal(nodes, others):
        nodes = np.concatenate([nodes, others])
    compare = partial(_compare_answers, first, second, under)
    pairs = pair_entries(first.data, second.data)
    first_name, second_name = cubes
    return CubeDiff(
        names=(first_name, second_name),
        cubes=(first, second),
        nodes=compare("nodes", nodes),
        pairs=pairs,
        entries=Changes(
            tuple(light.name for light in under),
            delta_e_under(under, *pairs.spectra),
            "entries",
            pairs.rgb,
            np.zeros(len(pairs.names), np.int64),
            pairs.names,
        ),
        images=tuple(
            compare(name, rgb.reshape(-1, 3)) for name, rgb in (images or {}).items()
        ),
    )


def _compare_answers(
    first: Cube, second: Cube, lights: Sequence[Light], name: str, rgb: Array
) -> Changes:
    """Compare the answers of two cubes to a set of colours (n, 3), by blocks."""

    def difference(rgb: Array) -> Array:
        at = first.wavelengths
        answers = [cube.reflectance(rgb, at) for cube in (first, second)]
        return delta_e_under(lights, *answers)

    delta_e = np.full((len(rgb), len(lights)), np.nan)
    lacking = np.where(first.covers(rgb), 0, 1) + np.where(second.covers(rgb), 0, 2)
    delta_e[lacking == 0] = blockwise(difference, rgb[lacking == 0], len(lights))
    names = tuple(light.name for light in lights)
    return Changes(names, delta_e, name, rgb, lacking)


def to_json(diff: CubeDiff, tolerance: float | None, worst: int) -> dict[str, Any]:
    """Return the figures of a comparison, with the worst colours of each set, for JSON.

    Rows without a difference come last.
    """
    differences = list[dict[str, Any]]()
    worst_colours = list[dict[str, Any]]()
    for changes in diff.sets:
        for row in changes.rows(tolerance):
            differences.append({"set": changes.set, **row})
        worst_colours += map(changes.describe, changes.worst_rows(worst).tolist())
    verdict = {}
    if tolerance is not None:
        verdict = {"tolerance": tolerance, "passed": diff.is_within(tolerance)}
    return {
        "cubes": list(diff.names),
        "largest": diff.largest,
        **verdict,
        "differences": sorted(differences, key=lambda row: row["max"] < INVISIBLE),
        "worst": worst_colours,
        "entries_removed": list(diff.pairs.removed),
        "entries_added": list(diff.pairs.added),
        "lacking": diff.lacking,
    }
