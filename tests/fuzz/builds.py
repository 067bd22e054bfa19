"""Odd builds, and the laws that cubes keep: ``python -m tests.fuzz.builds FIRST COUNT``
tries seeds.

Programs of JAX and C depend on few numbers of a build, so that most seeds find theirs
compiled by those before.
"""

import contextlib
import json
import shutil
import sys
import tempfile
import warnings
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
from click.testing import CliRunner
from scipy.optimize import linprog
from uplift_cli.main import main as command_line

import uplift
from tests.fuzz.commands import KEPT
from tests.fuzz.fuzzing import Random, choose
from tests.fuzz.programs import c_reflectances
from uplift.atlas.sources import write_atlas
from uplift.colorimetry import tables
from uplift.common.arrays import Array, Mask
from uplift.common.errors import UpliftWarning
from uplift.common.files import write_text
from uplift.cube.data import CubeData
from uplift.cube.file import digest
from uplift.extras import texture
from uplift.extras.export.program_table import moved_cells
from uplift.extras.export.rounding import rounding_error
from uplift.extras.timing import environment
from uplift.fit import base, batch
from uplift.lattice.lattice import CORNERS, Lattice
from uplift.lookup.interpolate import MODES

SPACES = (*tables.names("RGB space"), *["camera"] * 12)
OBSERVERS = (
    "CIE 1931 2 Degree Standard Observer",
    "CIE 1964 10 Degree Standard Observer",
)
CAMERAS = ("Nikon 5100 (NPL)", "Sigma SDMerill (NPL)")
EXACT = 1e-4
SAME = 1e-3
DEEP = 1e-4
SUM = 2e-6
"""Largest error of a realisable colour, and largest difference of reflectances between
languages, of colours that far inside the solid, with the error of RGB as a sum of some
hundred products in single precision. Near the boundary of the solid spectra are steps,
which single precision cannot place: an error d of RGB at the distance h moves a step by
about d / h of its width.
"""
NEAR = 1e-6
"""Distance in linear RGB within which single precision takes a colour for one of the
next cell.
"""
AT = (385.0, 450.0, 525.0, 600.0, 675.0, 775.0)
COUNTS = ((3, 3), (4, 9), (5, 17), (9, 9), (9, 13), (17, 17))
RANGES = ((380, 780, 5), (360, 830, 5), (380, 780, 10), (320, 900, 10))


@dataclass(frozen=True)
class Kind:
    """Numbers of builds from which programs are compiled: nodes along each axis,
    entries, coefficients, wavelengths.
    """

    dims: tuple[int, ...]
    sizes: tuple[int, ...] = (0, 0, 1, 2, 30)
    counts: tuple[tuple[int, int], ...] = COUNTS
    ranges: tuple[tuple[int, int, int], ...] = RANGES


SMALL = Kind((2, 3, 4, 6))
LARGE = Kind((12, 16, 40), (0, 1, 300))
QUICK = Kind((2, 3), (0, 1, 30), COUNTS[:2], RANGES[:1])
"""Builds of the test suite, which have few programs."""
TABLE = Lattice(np.linspace(0, 1, 5) ** 2)
"""Brightened colours of smooth spectra, from which small cubes start."""


@contextlib.contextmanager
def little_work() -> Iterator[None]:
    """Start from a coarse table of smooth spectra, and fit small batches: 17³ nodes
    would be most of the work.
    """
    with (
        mock.patch.object(base, "TABLE", TABLE),
        mock.patch.object(
            base,
            "smooth_table",
            lambda problem, goal: base.smooth(problem.model, problem.forward, goal),
        ),
        mock.patch.object(batch, "CPU_ROWS", (512, 32)),
    ):
        yield


def odd_options(random: Random, kind: Kind) -> dict[str, Any]:
    """Return options of a build, without atlas, library and looks."""
    options: dict[str, Any] = {
        "space": choose(random, SPACES),
        "dim": choose(random, kind.dims),
        "model": choose(random, ("moments", "moments", "moments", "sigmoid")),
        "illuminant": choose(random, ("D65", "D65", "A", "E", "D50", "FL2", "FL11")),
        "axis": choose(random, ("srgb", "linear")),
        "warp": choose(random, ("none", "vision")),
        # Learning is slow.
        "prior": choose(random, ("learnt", "smooth", "smooth", "smooth")),
    }
    is_camera = options["space"] == "camera"
    options["observer"] = choose(random, CAMERAS if is_camera else OBSERVERS)
    # Cameras are tabulated at steps of 5 nm.
    limits = choose(random, kind.ranges[:2] if is_camera else kind.ranges)
    options |= zip(("shortest", "longest", "step"), limits, strict=True)
    if options["model"] == "moments":
        counts = choose(random, kind.counts)
        options |= zip(("coefficients", "entry_coefficients"), counts, strict=True)
    return options


def odd_atlas(random: Random, size: int, path: Path) -> Path:
    """Write an atlas of entries of one shape: smooth, equal, dark, black, white or
    spiky.
    """
    at = np.arange(380.0, 781.0, 10)
    middle = random.uniform(380, 780, (size, 1))
    width = random.uniform(5, 200, (size, 1))
    level = random.uniform(0.02, 0.9, (size, 1))
    smooth = level * np.exp(-(((at - middle) / width) ** 2)) + 0.02
    shapes = (
        smooth,
        smooth[:1] + 0 * smooth,
        smooth / 100,
        0 * smooth,
        0 * smooth + 1,
        random.uniform(0, 1, smooth.shape).round(),
    )
    values = choose(random, shapes)
    entries = [uplift.Entry(f"e{k}", at, row) for k, row in enumerate(values)]
    write_atlas(uplift.Atlas(entries), path)
    return path


def distance_to_solid(matrix: Array, rgb: Array, near: Array) -> Array:
    """Return the least max |linear RGB| from colours (n, 3) that reflectances in [0, 1]
    have, by a linear program where a known reflectance is not as ``near`` as 1e-9.
    """
    distance = near.copy()
    count = matrix.shape[1]
    off = np.ones((3, 1))
    rows = np.block([[matrix, -off], [-matrix, -off]])
    cost = np.append(np.zeros(count), 1)
    limits = [(0, 1)] * count + [(0, None)]
    for row in np.flatnonzero(near > 1e-9):
        right = np.concatenate([rgb[row], -rgb[row]])
        distance[row] = linprog(cost, A_ub=rows, b_ub=right, bounds=limits).fun
    return distance


def colours(random: Random, cube: uplift.Cube) -> np.ndarray:
    """Return colours (n, 3) in [0, 1]: random, dark, pure, of entries, and
    near them.
    """
    rgb = random.uniform(0, 1, (24, 3))
    rgb[8:12] **= 4
    rgb[12:16, int(random.integers(3))] = random.uniform(0, 0.02)
    rgb[16:20] = rgb[16:20].round()
    entries = cube.data.atlas.rgb[:4]
    near = np.clip(entries + random.normal(0, 0.02, entries.shape), 0, 1)
    rgb = np.concatenate([rgb, entries, near])
    return rgb.astype(np.float32).astype(float)


def broken_laws(seed: int, folder: Path, kind: Kind = SMALL) -> Iterator[str]:
    """Build a cube by a seed, and yield the laws that it breaks."""
    random = np.random.default_rng(seed)
    options = odd_options(random, kind)
    size = choose(random, kind.sizes)
    given: dict[str, Any] = {"atlas": None}
    if size:
        given["atlas"] = odd_atlas(random, size, folder / "atlas.csv")
    is_learnt = options["prior"] == "learnt" and options.get("coefficients", 3) > 3
    if is_learnt and random.random() < 0.5:
        given["library"] = odd_atlas(random, 12, folder / "library.csv")
    if options.get("entry_coefficients", 3) > 3 and options["space"] != "camera":
        light = "A" if options["illuminant"] != "A" else "D65"
        own, other = random.uniform(0.2, 0.6, (2, 3))
        if random.random() < 0.15:
            given["looks"] = uplift.Look(tuple(own), {light: tuple(other)})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        cube = uplift.build(**given, **options)
        cube.save(folder / "cube.uplift")
        if seed % 8 == 0 and digest(uplift.build(**given, **options).data) != digest(
            cube.data
        ):
            yield "the same build has another digest"
        yield from _file_laws(cube, folder, check=seed % 8 == 4)
        yield from _colour_laws(cube, colours(random, cube), folder)


def _file_laws(cube: uplift.Cube, folder: Path, check: bool) -> Iterator[str]:
    loaded = uplift.load(folder / "cube.uplift")
    if digest(loaded.data) != digest(cube.data):
        yield "the file has another digest"
    if check:
        args = ["check", str(folder / "cube.uplift"), "--format", "json"]
        result = CliRunner().invoke(command_line, args)
        if result.exit_code:
            yield (
                f"check: exit code {result.exit_code}: {result.exception!r} "
                f"{result.stderr[-200:]}"
            )


def _colour_laws(cube: uplift.Cube, rgb: Array, folder: Path) -> Iterator[str]:
    sensor = cube.data.sensor
    for mode in MODES:
        if not are_reflectances(cube.reflectance(rgb, mode=mode)):
            yield f"{mode}: reflectances outside [0, 1]"
    spectra = cube.reflectance(rgb)
    error = np.abs(sensor.rgb(spectra) - rgb).max(axis=1)
    off = distance_to_solid(sensor.matrix, rgb, error)
    for worst in np.flatnonzero((off < 1e-9) & (error > EXACT)):
        yield f"realisable colour {rgb[worst].tolist()} missed by {error[worst]:.1e}"
    expected = cube.reflectance(rgb, AT)
    yield from _command_laws(rgb, off, expected, folder)
    for mode in ("spectra", "moments") if shutil.which("cc") else ():
        yield from _program_laws(cube, mode, rgb)
    stored = texture.prepare(cube, texture.Spectrum(AT)).pixels.sample(
        rgb.astype(np.float32)
    )
    difference = np.abs(stored - expected).max()
    if difference > 1e-5:
        yield f"textures of spectra differ by {difference:.1e}"


def are_reflectances(values: Array) -> bool:
    return bool(np.isfinite(values).all() and values.min() >= 0 and values.max() <= 1)


def _command_laws(
    rgb: Array, off: Array, expected: Array, folder: Path
) -> Iterator[str]:
    """Compare the answers of ``uplift query`` with reflectances (n, N), and with the
    distances (n,) from the solid.
    """
    rows = [",".join(map(repr, row)) for row in rgb.tolist()]
    (folder / "colours.csv").write_text("\n".join(rows))
    wavelengths = ",".join(map(str, AT))
    line = (
        f"query --cube {folder}/cube.uplift --input {folder}/colours.csv --format json "
        f"--wavelengths {wavelengths}"
    )
    answers = json.loads(CliRunner().invoke(command_line, line.split()).stdout)
    for answer, missed, row in zip(answers, off, expected, strict=True):
        realisable = answer.get("realisable", True)
        is_certain = not 1e-9 < missed < 1e-6
        if is_certain and realisable != (missed < 1e-6):
            yield (
                f"realisable is {realisable}, {missed:.1e} from the nearest: "
                f"{answer['rgb']}"
            )
        if np.abs(np.array(answer["reflectance"]) - row).max() > 1e-6:
            yield "the command line has other reflectances"


def _program_laws(cube: uplift.Cube, mode: str, rgb: Array) -> Iterator[str]:
    spectra = c_reflectances(cube.data, mode, rgb, np.array(AT))
    if not are_reflectances(spectra):
        yield f"C, {mode}: reflectances outside [0, 1]: {spectra.min()} {spectra.max()}"
    difference = np.abs(spectra - cube.reflectance(rgb, AT, mode)).max(axis=1)
    stated = rounding_error(cube.data, mode)
    stays = stay(cube.data, mode, rgb)
    for row in np.flatnonzero(stays & (difference > stated)):
        yield (
            f"C, {mode}: states {stated:.1e}, but differs by {difference[row]:.1e}: "
            f"{rgb[row].tolist()}"
        )
    depth = -cube.data.solid.signed_distance(rgb)
    limit = np.maximum(np.maximum(SAME, SUM / np.maximum(depth, DEEP)), 2 * stated)
    for row in np.flatnonzero(~stays & (depth > DEEP) & (difference > limit)):
        yield (
            f"C, {mode}: differs by {difference[row]:.1e} at the depth "
            f"{depth[row]:.1e}: {rgb[row].tolist()}"
        )


def stay(data: CubeData, mode: str, rgb: Array) -> Mask:
    """Return which colours (n, 3) are interpolated inside cells whose answers are not
    moved.
    """
    hits = data.entry_boxes.locate(rgb)[2]
    place = rgb.copy()
    place[hits.rows] = hits.exit_rgb
    moved = moved_cells(data, mode)
    lattice = data.lattice
    corners = (np.clip(place + NEAR * corner, 0, 1) for corner in 2 * CORNERS - 1)
    return ~np.any(
        [moved[lattice.index(lattice.cell(corner)[0])] for corner in corners], axis=0
    )


def broken(seed: int, kind: Kind = SMALL) -> list[str]:
    """Return the laws that the build of a seed breaks."""
    with (
        tempfile.TemporaryDirectory() as folder,
        little_work() if kind != LARGE else contextlib.nullcontext(),
    ):
        try:
            return [
                f"build {seed}: {law}" for law in broken_laws(seed, Path(folder), kind)
            ]
        except Exception as problem:  # one build must not end a night
            # Spikes may all be outside the space.
            refused = getattr(problem, "code", "") == "atlas-out-of-gamut"
            return [] if refused else [f"build {seed}: {problem!r}"]


def main(first: int, count: int) -> int:
    """Try seeds, every fiftieth with a large cube, print the laws that they break, and
    return their number.

    The figures of the page are written after each build: an interrupted run counts
    those that it had.
    """
    laws = Counter[str]()
    KEPT.mkdir(parents=True, exist_ok=True)
    limits = {"colour": EXACT, "programs": SAME, "sums": SUM, "boundary": DEEP}
    figures = {"command": "make nightly", "environment": environment(), "first": first}
    figures["limits"] = limits
    for seed in range(first, first + count):
        findings = broken(seed, LARGE if seed % 50 == 0 else SMALL)
        laws.update(law.split(":")[1].strip() for law in findings)
        print(*findings, sep="\n", end="\n" * bool(findings), flush=True)
        figures |= {"builds": seed - first + 1, "broken": laws}
        write_text(
            json.dumps(figures, indent=1) + "\n", KEPT / "builds.json", force=True
        )
    print(f"{laws.total()} laws broken by {count} builds")
    return laws.total()


if __name__ == "__main__":
    sys.exit(bool(main(*map(int, sys.argv[1:]))))
