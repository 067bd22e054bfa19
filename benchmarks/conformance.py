"""The conformance kit run by our own lookups and by Mitsuba, and with mistakes, for
docs/guides/conformance.md.
"""

import runpy
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks import DOCS, Row
from benchmarks.programs import compile_c, output
from uplift.common.arrays import Array, Values
from uplift.cube.data import CubeData, EntrySpectra
from uplift.extras.export.program import write_program
from uplift.extras.export.runtime import HEADER, write_header
from uplift.extras.files.csv import csv_text
from uplift.extras.processes import call_in_child
from uplift.extras.report.conformance import (
    PICTURE_LIMITS,
    Conformance,
    check_renderer,
    compare,
    picture_reference,
)
from uplift.extras.report.conformance_chart import make_chart
from uplift.extras.report.conformance_results import spectra_wavelengths
from uplift.lookup.cube import Cube, load
from uplift.models.moments import Moments

KIT = DOCS / "conformance"
CUBE = KIT / "conformance.uplift"
LIGHTS = ("A", "D65", "FL11")
SPP = 256
LIMIT = 600
"""Seconds after which a rendering counts as hung."""
PROGRAM = Path(__file__).with_suffix(".c")


def by_reader(folder: Path) -> Path:
    """Compute the spectra by the reader of the documentation."""
    cube = runpy.run_path(str(DOCS / "reader.py"))["Cube"](CUBE)
    at = spectra_wavelengths()
    spectra = [cube.reflectance(rgb, at) for rgb in colours()]
    return write_table(folder / "reader.csv", np.array(spectra))


def by_header(folder: Path, mode: str = "spectra") -> Path:
    """Compute the spectra by an exported header in C."""
    write_program(load(CUBE).data, folder / "cube.h", mode=mode, force=True)
    return write_table(folder / f"header-{mode}.csv", run_program(folder))


def by_runtime(folder: Path) -> Path:
    """Compute the spectra by uplift.h."""
    write_header(folder / HEADER, force=True)
    return write_table(folder / "runtime.csv", run_program(folder, "-DRUNTIME"))


def run_program(folder: Path, *flags: str) -> Values:
    """Compile and run the program. Returns reflectances (1000, 31)."""
    program = compile_c(PROGRAM, folder, "-O0", *flags)
    given = colours().astype(np.float32).tobytes()
    answer = output(program, CUBE, given=given)
    return np.frombuffer(answer, np.float32).reshape(-1, 31)


def colours() -> Array:
    """Read the colours (1000, 3) of the kit."""
    return np.loadtxt(KIT / "colours.csv", delimiter=",", skiprows=1)


def write_table(path: Path, spectra: Values) -> Path:
    """Write reflectances (1000, 31) as a table for `check_renderer`."""
    header = [*"rgb", *map("{:g}".format, spectra_wavelengths())]
    rows = np.column_stack([colours(), spectra]).tolist()
    path.write_text(csv_text(header, rows))
    return path


def render(folder: Path, light: str, texture: str, spp: int) -> Path:
    """Render the scene of the kit by Mitsuba, a pixel a patch. The texture is
    ``uplift``, or Mitsuba's ``bitmap``, which has its own table.
    """
    import mitsuba as mi

    from benchmarks.mitsuba_scenes import start_mitsuba

    start_mitsuba()
    mi.file_resolver().prepend(str(KIT))
    scene = (KIT / "scene.xml").read_text(encoding="utf-8")
    if texture != "uplift":
        scene = scene.replace('type="uplift"', f'type="{texture}"')
        scene = scene.replace('<string name="cube" value="conformance.uplift"/>', "")
    size = {"width": "40", "height": "25", "spp": str(spp)}
    loaded = mi.load_string(scene, light=light, **size)
    path = folder / f"{texture}-{light}.exr"
    mi.Bitmap(mi.render(loaded)).write(str(path))
    return path


SPECTRA: dict[str, Callable[[Path], Path]] = {
    "Python, `docs/reader.py`": by_reader,
    "C, exported header": by_header,
    "C, exported header, `--mode moments`": partial(by_header, mode="moments"),
    "C, `uplift.h`": by_runtime,
}
"""Lookups, and how they write a table of spectra to a folder."""
TEXTURES = {
    "uplift": "Mitsuba, the plug-in",
    "bitmap": "Mitsuba without it",
}


def lookups() -> Iterator[Row]:
    """Yield the figures of our own lookups and of Mitsuba."""
    cube = load(CUBE)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for lookup, write in SPECTRA.items():
            yield as_row(lookup, check_renderer(write(folder), cube))
        for light in LIGHTS:
            for texture, lookup in TEXTURES.items():
                path = call_in_child(render, folder, light, texture, SPP, seconds=LIMIT)
                yield as_row(lookup, check_renderer(path, cube, light))


def as_row(name: str, result: Conformance) -> Row:
    """Return the figures of a comparison."""
    return {
        "lookup": name,
        "light": result.light,
        "mode": result.mode,
        **result.differences._asdict(),
        "verdict": "passed" if result.passed else "failed",
        "explanation": result.explanation,
    }


def mistakes() -> Iterator[Row]:
    """Yield the figures of pictures without noise that lookups with a mistake give."""
    cube = load(CUBE)
    data = cube.data
    chart = make_chart(data)
    reference = picture_reference(cube, chart, "A")
    spectra = data.atlas.spectra
    plain = EntrySpectra(Moments(spectra.model.count), spectra.coefficients)
    no_boxes = np.zeros_like(data.atlas.half_width)

    def by_cube(**changes: object) -> Array:
        changed: CubeData = replace(data, **changes)
        return replace(reference, cube=Cube(changed)).xyz("spectra")

    right = cube.reflectance(chart.rgb)
    at = cube.wavelengths
    coarse = [np.interp(at, at[::4], row[::4]) for row in right]
    to_xyz = reference.light.xyz.T
    pictures = {
        "RGB times the RGB of the light": reference.product(),
        "the nearest node": reference.xyz("nearest"),
        "no warp": by_cube(
            model=Moments(data.model.count), atlas=replace(data.atlas, spectra=plain)
        ),
        "no boxes of entries": by_cube(atlas=replace(data.atlas, half_width=no_boxes)),
        "wavelengths shifted by 5 nm": np.roll(right, 1, axis=1) @ to_xyz,
        "spectra every 20 nm": np.array(coarse) @ to_xyz,
        "spectra of 8 bits": np.round(255 * right) / 255 @ to_xyz,
        "a tenth too bright": 1.1 * reference.xyz("spectra"),
    }
    for name, xyz in pictures.items():
        yield as_row(name, compare(xyz, reference, PICTURE_LIMITS))


QUESTIONS = {"lookups": lookups, "mistakes": mistakes}
