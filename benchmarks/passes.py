"""Errors of passes of an RGB renderer by bands, decoding and reflections, and the page
of a room, for docs/guides/passes.md.
"""

import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path

import numpy as np

import uplift
from benchmarks import DOCS, Row
from benchmarks.browser import browser
from benchmarks.checker import chart
from benchmarks.passes_page import page
from benchmarks.timing import time_call
from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.common.files import write_text
from uplift.extras import texture
from uplift.extras.colour.light_sets import PALETTE_LIGHTS
from uplift.extras.images.converter import Converter
from uplift.extras.papers.palette.factor import factor_model
from uplift.extras.papers.wavelengths.choice import choose
from uplift.extras.papers.wavelengths.sampling import grid, make_setup
from uplift.extras.scene import passes as library
from uplift.extras.scene.passes.bands import CHANNELS, Bands
from uplift.extras.scene.passes.choice import judging_paths
from uplift.extras.scene.passes.materials import Materials
from uplift.extras.scene.passes.passes import Passes
from uplift.fit.families import shipped_library
from uplift.samples import sample_path

LIGHTS = ("D65", "A", "FL2", "FL11", "LED-B3", "HP1")
COUNTS = (1, 2, 3, 4)
OTHER_LIGHTS = ("D50", "FL4", "FL7", "LED-V1", "LED-RGB1")
"""Lights that no passes are fitted to."""
MATERIALS = 100
"""Materials that wavelengths are optimised for, which takes long for more."""
IMAGE = "still-life.png"
WINDOW = (1240, 830)
"""Pixels of the window of the page."""
FRAMES_SECONDS = 40
"""Seconds until a picture of the page is taken."""
ROOM = DOCS / "passes" / "room.html"


@dataclass(frozen=True, eq=False)
class Basis:
    """Weights (K, 81) in place of bands."""

    weights: Array

    def __len__(self) -> int:
        return len(self.weights)


@cache
def materials() -> Materials:
    """Return the materials of the library, half of them held out."""
    return library.library_materials()


@cache
def chosen(count: int) -> Passes:
    """Choose the bands of passes."""
    return library.choose(materials(), LIGHTS, count)


def rows_of(errors: Array, lights: Sequence[str], **labels: object) -> Iterator[Row]:
    """Yield a row for each light of errors (L, 4) after one to four reflections."""
    for light, of_light in zip(lights, errors, strict=True):
        by_number = {str(number): error for number, error in enumerate(of_light, 1)}
        yield {**labels, "light": light, **by_number, "mean": of_light.mean()}


def errors() -> Iterator[Row]:
    """Yield the errors of RGB, and of bands and points of one to four passes, by one
    matrix for all lights and by a matrix for each.
    """
    plain = library.rgb_errors(materials(), LIGHTS)
    yield from rows_of(plain, LIGHTS, kind="RGB", passes=0, decoding="shared")
    for count in COUNTS:
        points = library.choose(materials(), LIGHTS, count, width=0)
        for kind, fitted in (("bands", chosen(count)), ("points", points)):
            shared = np.stack([light.errors for light in fitted.lights])
            own = np.stack([light.own_errors for light in fitted.lights])
            of = {"kind": kind, "passes": count}
            yield from rows_of(shared, LIGHTS, **of, decoding="shared")
            yield from rows_of(own, LIGHTS, **of, decoding="own")


def other_bases() -> Iterator[Row]:
    """Yield the errors of other choices of as many numbers as two passes have, decoded
    in the same way.
    """
    count = 2 * CHANNELS
    training = materials().training[:: -(-len(materials().training) // MATERIALS)]
    fine = grid()
    table = observer.grid()
    resampled = [np.interp(fine, table, row) for row in np.clip(training, 0, 1)]
    setup = make_setup(np.stack(resampled), LIGHTS)
    smooth = np.stack([library.scaled_power(name) for name in PALETTE_LIGHTS])
    model = factor_model(observer.sensor(), training, smooth, count)
    bases = {"factor model": Basis(model.projection)}
    for method in ("optimised", "meyer", "uniform"):
        found = choose(setup, count=count, method=method)
        bases[method] = Bands(tuple(found.sampling.wavelengths), 0.0)
    for name, basis in bases.items():
        fitted = library.fit_bands(basis, materials(), LIGHTS)
        shared = np.stack([light.errors for light in fitted.lights])
        yield {"kind": name, "mean": shared.mean()}


def other_lights() -> Iterator[Row]:
    """Yield the errors under lights that no passes are fitted to."""
    judged = judging_paths(materials(), OTHER_LIGHTS)
    plain = library.rgb_errors(materials(), OTHER_LIGHTS)
    yield from rows_of(plain, OTHER_LIGHTS, passes=0)
    for count in COUNTS:
        passes = chosen(count)
        numbers = np.maximum(passes.light_numbers(judged.powers), 0)
        lit = judged.numbers(passes.bands.weights) * numbers[:, None]
        by_bounce = judged.by_bounce(judged.errors(lit @ passes.to_xyz.T))
        yield from rows_of(by_bounce, OTHER_LIGHTS, passes=count)


def without_family(name: str, held_out: Array) -> Materials:
    """Return the library without a family, and other materials that judge."""
    known = [family.measured for family in shipped_library([name])]
    return Materials(np.concatenate(known), held_out, {"source": "library"})


def families() -> Iterator[Row]:
    """Yield the errors on families of which no material was known."""
    for family in shipped_library():
        divided = without_family(family.name, family.measured)
        known = {"family": family.name, "materials": len(family.measured)}
        plain = library.rgb_errors(divided, LIGHTS).mean()
        yield {**known, "passes": 0, "mean": plain}
        for count in COUNTS[:3]:
            error = library.choose(divided, LIGHTS, count).error
            yield {**known, "passes": count, "mean": error}


def textures() -> Iterator[Row]:
    """Yield bytes and seconds of textures of passes, and of 31 wavelengths."""
    cube = uplift.load()
    source = sample_path(IMAGE)
    at = np.arange(400.0, 701, 10).tolist()
    kinds = {"31 wavelengths": [texture.prepare(cube, texture.Spectrum(tuple(at)))]}
    for count in COUNTS:
        numbers = range(1, count + 1)
        kinds[f"{count}"] = [
            library.prepare_pass(cube, chosen(count), number) for number in numbers
        ]
    with tempfile.TemporaryDirectory() as folder:
        for name, converters in kinds.items():
            convert = partial(convert_all, converters, source, Path(folder))
            size = convert()  # compiles
            seconds = time_call(convert).wall
            yield {"kind": name, "bytes": size, "seconds": seconds}


def convert_all(converters: Sequence[Converter], source: Path, folder: Path) -> int:
    """Convert an image by all converters; return the bytes of the textures."""
    size = 0
    for number, converter in enumerate(converters):
        target = folder / f"{number}.exr"
        texture.convert(converter, source, target, force=True)
        size += target.stat().st_size
    return size


def write_page() -> None:
    """Write the page of the room, and a picture of it after some frames."""
    write_text(page(chosen(2), chart().measured), ROOM, force=True)
    with browser() as tab:
        tab.window(*WINDOW)
        tab.open(ROOM)
        time.sleep(FRAMES_SECONDS)
        ROOM.with_suffix(".jpg").write_bytes(tab.screenshot("main"))


QUESTIONS = {
    "errors": errors,
    "bases": other_bases,
    "other_lights": other_lights,
    "families": families,
    "textures": textures,
    "page": write_page,
}
