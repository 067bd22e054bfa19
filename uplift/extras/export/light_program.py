"""An emission table as a program for renderers and shaders, in C or GLSL."""

from pathlib import Path

import numpy as np

from uplift.common.arrays import Array, StrPath
from uplift.common.text import pluralise
from uplift.extras.emission.discs import MIN_RADIUS, touched_bins
from uplift.extras.emission.file import EmissionData, emission_digest
from uplift.extras.emission.lattice import DENOMINATOR, ChromaticityLattice
from uplift.extras.emission.lookup import EmissionTable
from uplift.extras.export.program import check_form, compose, write_files
from uplift.extras.export.program_table import Table, concatenate
from uplift.extras.export.source import comment

BIN_COUNT = 96
"""Bins of each axis of u′v′, from 0 to 1: most touch no lamp, or one."""
PER_LINE = 27
"""Numbers in a line of a header."""


def export(
    lights: EmissionTable,
    path: Path,
    style: str,
    *,
    force: bool,
    table: str | None = None,
) -> str:
    """Write a program and its table."""
    written = write_light_program(
        lights.data, path, style=style, form=table, force=force
    )
    knots, rings = lights.data.lattice.shape
    size = sum(file.stat().st_size for file in written) / 1e6
    facts = [
        pluralise(knots * rings, "node"),
        pluralise(len(lights.lamp_names), "lamp"),
        f"{size:.1f} MB",
        *(f"table in {file}" for file in written[1:]),
    ]
    return ", ".join(facts)


def write_light_program(
    data: EmissionData,
    path: StrPath,
    *,
    style: str = "c",
    form: str | None = None,
    force: bool = False,
) -> list[Path]:
    """Write an emission table as a program in C or GLSL, as
    `uplift.extras.export.program.write_program` does for a cube; return the files.
    """
    path = Path(path)
    form = check_form(style, form)
    table = make_light_table(data)
    words = {
        "digest": emission_digest(data),
        "space": comment(data.space),
        "observer": comment(data.observer),
        "lamps": len(data.entries.names),
        "width": 4,
    }
    text = compose("lights", table, style, path.stem, form, words)
    return write_files(text, table, path, form, per_line=PER_LINE, force=force)


def make_light_table(data: EmissionData) -> Table:
    """Lay out spectra of the nodes, with the first knot repeated at the end, spectra of
    lamps, and what finds them.
    """
    lattice = data.lattice
    lamps = data.entries
    kept = lamps.radius >= MIN_RADIUS
    uv = lamps.uv[kept]
    radius = lamps.radius[kept]
    knots, rings = lattice.shape
    angles, inverses = lattice.sectors()
    numbers, offsets = concatenate(
        {
            "NODES": np.concatenate([data.spectra, data.spectra[:1]]),
            "LAMP_SPECTRA": lamps.spectra[kept],
            "MATRIX": _matrix(data),
            "WHITE": np.array([*lattice.white, _first_angle(lattice)]),
            "ANGLES": angles,
            "INVERSES": inverses,
            "RING_SHARES": lattice.rings,
            "LAMPS": np.column_stack([uv, radius]),
            "BINS": _bins(uv, radius),
        }
    )
    at = data.wavelengths
    sizes = {"KNOTS": knots, "RINGS": rings, "SAMPLES": len(at), "BIN_COUNT": BIN_COUNT}
    return Table(
        numbers,
        {**sizes, **offsets, "START": float(at[0]), "STEP": float(at[1] - at[0])},
    )


def _matrix(data: EmissionData) -> Array:
    """Return rows from linear RGB to u′ and v′ from white times the size, the size X +
    15 Y + 3 Z, and white's size.
    """
    white = data.lattice.white
    rows = np.array(
        [
            [4, 0, 0] - white[0] * DENOMINATOR,
            [0, 9, 0] - white[1] * DENOMINATOR,
            DENOMINATOR,
        ]
    )
    luminance = np.array([[0, 9 / white[1], 0]])
    return np.concatenate([rows, luminance]) @ data.rgb_to_xyz


def _first_angle(lattice: ChromaticityLattice) -> float:
    """Return the angle of the first knot, as ``up_angle`` in the program."""
    u, v = lattice.knots[0] - lattice.white
    slope = u / (abs(u) + abs(v))
    return float(3 + slope if v < 0 else 1 - slope)


def _bins(uv: Array, radius: Array) -> Array:
    """Return the position of each bin's list of lamps, and the lists, each after its
    length.
    """
    places = np.full((BIN_COUNT, BIN_COUNT), BIN_COUNT**2)
    lists = [0]
    for (row, column), listed in touched_bins(uv, radius, BIN_COUNT).items():
        places[row, column] = BIN_COUNT**2 + len(lists)
        lists += [len(listed), *listed]
    return np.concatenate([places.ravel(), lists]).astype(float)
