"""The conformance kit run by our own lookups and by Mitsuba, and with mistakes, for
docs/guides/conformance.md.
"""

import importlib.util
import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path
from types import ModuleType

import numpy as np

from benchmarks import DOCS, Row, record
from uplift.common.arrays import Array, Values
from uplift.cube import CubeData, EntrySpectra
from uplift.extras.export import write_program
from uplift.extras.export.runtime import HEADER, write_header
from uplift.extras.files.csv import csv_text
from uplift.extras.images.processes import call_in_child
from uplift.extras.report.conformance import (
    PICTURE_LIMITS,
    SPECTRA_LIMITS,
    Conformance,
    check_renderer,
    compare,
    picture_reference,
)
from uplift.extras.report.conformance_chart import make_chart
from uplift.extras.report.conformance_results import spectra_wavelengths
from uplift.lab.timing import environment
from uplift.lookup import Cube, load
from uplift.models import Moments

KIT = DOCS / "conformance"
CUBE = KIT / "conformance.uplift"
LIGHTS = ("A", "D65", "FL11")
SPP = 256
LIMIT = 600
"""Seconds after which a rendering counts as hung."""
PROGRAM = r"""
#include <stdio.h>
#ifdef RUNTIME
#define UPLIFT_IMPLEMENTATION
#include "uplift.h"
#else
#include "cube.h"
#endif

int main(int count, char **words)
{
    float rgb[3], at[31], found[31];
    for (int k = 0; k < 31; ++k) at[k] = 400.0f + 10.0f * (float)k;
#ifdef RUNTIME
    int error;
    uplift_cube *cube = uplift_open(words[count - 1], &error);
    if (!cube) return error;
#else
    (void)count, (void)words;
#endif
    while (fread(rgb, sizeof rgb, 1, stdin) == 1) {
#ifdef RUNTIME
        if (uplift_reflectances(cube, rgb, at, 31, found) != UPLIFT_OK) return 99;
#else
        cube_reflectances(rgb, at, 31, found);
#endif
        fwrite(found, sizeof found, 1, stdout);
    }
    return 0;
}
"""


def main() -> None:
    """Run all lookups and mistakes, and write docs/data/conformance.json."""
    cube = load(CUBE)
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for lookup, write in SPECTRA.items():
            result = check_renderer(write(folder), cube)
            rows.append(as_row(lookup, result))
        for light in LIGHTS:
            for texture in ("uplift", "bitmap"):
                path = call_in_child(render, folder, light, texture, SPP, seconds=LIMIT)
                result = check_renderer(path, cube, light)
                rows.append(as_row(TEXTURES[texture], result))
    record(
        "conformance",
        environment=environment(),
        spp=SPP,
        limits={"picture": asdict(PICTURE_LIMITS), "spectra": asdict(SPECTRA_LIMITS)},
        lookups=rows,
        mistakes=[as_row(name, result) for name, result in mistakes(cube)],
    )


def as_row(name: str, result: Conformance) -> Row:
    """Return the figures of a comparison."""
    return {
        "lookup": name,
        "light": result.light,
        "mode": result.mode,
        **asdict(result.differences),
        "verdict": "passed" if result.passed else "failed",
        "explanation": result.explanation,
    }


def reader() -> ModuleType:
    """Import docs/reader.py."""
    spec = importlib.util.spec_from_file_location("reader", DOCS / "reader.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def by_reader(folder: Path) -> Path:
    """Compute the spectra by the reader of the documentation."""
    cube = reader().Cube(CUBE)
    at = spectra_wavelengths()
    spectra = [cube.reflectance(rgb, at) for rgb in colours()]
    return write_table(folder / "reader.csv", np.array(spectra))


def by_header(folder: Path, mode: str = "spectra") -> Path:
    """Compute the spectra by an exported header in C."""
    write_program(load(CUBE).data, folder / "cube.h", mode=mode, force=True)
    return write_table(folder / f"header-{mode}.csv", run_program(folder))


def by_header_of_moments(folder: Path) -> Path:
    """Compute the spectra by an exported header in C that interpolates moments."""
    return by_header(folder, "moments")


def by_runtime(folder: Path) -> Path:
    """Compute the spectra by uplift.h."""
    write_header(folder / HEADER, force=True)
    return write_table(folder / "runtime.csv", run_program(folder, "-DRUNTIME"))


def run_program(folder: Path, *options: str) -> Values:
    """Compile and run the program. Returns reflectances (1000, 31)."""
    (folder / "main.c").write_text(PROGRAM)
    compiler = ["cc", "-O0", *options, "main.c", "-o", "main", "-lm"]
    subprocess.run(compiler, cwd=folder, check=True)
    done = subprocess.run(
        [folder / "main", CUBE],
        input=colours().astype(np.float32).tobytes(),
        capture_output=True,
        check=True,
    )
    return np.frombuffer(done.stdout, np.float32).reshape(-1, 31)


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

    from uplift.extras.mitsuba import register

    mi.set_variant("scalar_spectral")
    register()
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
    "C, exported header, `--mode moments`": by_header_of_moments,
    "C, `uplift.h`": by_runtime,
}
"""Lookups, and how they write a table of spectra to a folder."""
TEXTURES = {
    "uplift": "Mitsuba, the plug-in",
    "bitmap": "Mitsuba without it",
}


def mistakes(cube: Cube) -> list[tuple[str, Conformance]]:
    """Compare pictures without noise that lookups with a mistake give."""
    data = cube.data
    chart = make_chart(data)
    reference = picture_reference(cube, chart, "A")

    def result(xyz: Array) -> Conformance:
        return compare(xyz, reference, PICTURE_LIMITS)

    def by_cube(changed: CubeData) -> Conformance:
        return result(replace(reference, cube=Cube(changed)).xyz("spectra"))

    atlas = data.atlas
    plain = EntrySpectra(Moments(atlas.spectra.model.count), atlas.spectra.coefficients)
    without_warp = replace(
        data,
        model=Moments(data.model.count),
        atlas=replace(atlas, spectra=plain),
    )
    without_boxes = replace(
        data, atlas=replace(atlas, half_width=np.zeros_like(atlas.half_width))
    )
    right = cube.reflectance(chart.rgb)
    codes = np.round(255 * right) / 255
    coarse = np.array(
        [np.interp(cube.wavelengths, cube.wavelengths[::4], row[::4]) for row in right]
    )
    to_xyz = reference.light.xyz.T
    return [
        ("RGB times the RGB of the light", result(reference.product())),
        ("the nearest node", result(reference.xyz("nearest"))),
        ("no warp", by_cube(without_warp)),
        ("no boxes of entries", by_cube(without_boxes)),
        ("wavelengths shifted by 5 nm", result(np.roll(right, 1, axis=1) @ to_xyz)),
        ("spectra every 20 nm", result(coarse @ to_xyz)),
        ("spectra of 8 bits", result(codes @ to_xyz)),
        ("a tenth too bright", result(1.1 * reference.xyz("spectra"))),
    ]
