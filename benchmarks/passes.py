"""Errors of passes of an RGB renderer by bands, decoding and bounces, and a room in
Mitsuba, for docs/guides/passes.md and its pictures.

The room is rendered in child processes, as Mitsuba has one variant a process here.
"""

import base64
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import uplift
from benchmarks import DOCS, Row, passes_room, record
from benchmarks.browser import browser
from benchmarks.checker import chart
from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.files import write_text
from uplift.extras.palette.factor import factor_model
from uplift.extras.scene import passes as library
from uplift.extras.scene import wavelengths
from uplift.extras.scene.passes import Materials, Passes
from uplift.extras.scene.passes.browser_page import page
from uplift.extras.scene.passes.choice import (
    JUDGING_PATHS,
    JUDGING_SEED,
    fit_bands,
)
from uplift.extras.scene.passes.light_paths import draw_paths
from uplift.fit import shipped_library
from uplift.samples import sample_path

LIGHTS = ("D65", "A", "FL2", "FL11", "LED-B3", "HP1")
COUNTS = (1, 2, 3, 4)
OTHER_LIGHTS = ("D50", "FL4", "FL7", "LED-V1", "LED-RGB1")
"""Lights that no passes are fitted to."""
SMOOTH = ("D65", "A", "D50", "E")
"""Lights of the factor model, which spiky ones do not improve."""
MATERIALS = 100
"""Materials that wavelengths are optimised for, which takes long for more."""
IMAGE = "still-life.png"
WINDOW = (1240, 830)
"""Pixels of the window of the page."""
FRAMES_SECONDS = 40
"""Seconds until a picture of the page is taken."""
BANDS = "bands"
POINTS = "points"


@dataclass(frozen=True, eq=False)
class Basis:
    """Weights (K, 81) in place of bands."""

    weights: Array

    def __len__(self) -> int:
        return len(self.weights)


def rows_of(fitted: Passes, **labels: object) -> list[Row]:
    """Return a row for the shared and one for the own decodings of passes."""
    shared = np.mean([light.errors for light in fitted.lights], axis=0)
    own = np.mean([light.own_errors for light in fitted.lights], axis=0)
    rows = []
    for decoding, errors in (("shared", shared), ("own", own)):
        means = {str(count): errors[count - 1] for count in range(1, 5)}
        rows.append(
            {**labels, "decoding": decoding, "bounces": means, "mean": errors.mean()}
        )
    return rows


def measure_choices(materials: Materials) -> tuple[dict[int, Passes], list[Row]]:
    """Choose bands and points of one to four passes."""
    chosen = {}
    rows = []
    for count in COUNTS:
        for kind, width in ((BANDS, None), (POINTS, 0)):
            begin = time.perf_counter()
            passes = library.choose(materials, LIGHTS, count, width=width)
            seconds = time.perf_counter() - begin
            labels = {
                "passes": count,
                "kind": kind,
                "centres": list(passes.bands.centres),
                "width": passes.bands.width,
                "seconds": seconds,
            }
            rows += rows_of(passes, **labels)
            if kind == BANDS:
                chosen[count] = passes
    return chosen, rows


def other_bases(materials: Materials) -> Iterator[Row]:
    """Yield the errors of other choices of as many numbers, decoded in the same way."""
    table = observer.grid()
    sensor = observer.sensor()
    step = -(-len(materials.training) // MATERIALS)
    fine = wavelengths.grid()
    resampled = [
        np.interp(fine, table, row) for row in np.clip(materials.training[::step], 0, 1)
    ]
    setup = wavelengths.make_setup(np.stack(resampled), LIGHTS)
    smooth = np.stack([library.scaled_power(name) for name in SMOOTH])
    for count in COUNTS:
        bases: dict[str, Array | None] = {}
        for method in ("optimised", "meyer", "uniform"):
            try:
                found = wavelengths.choose(setup, count=3 * count, method=method)
                bases[method] = point_weights(found.sampling.wavelengths)
            except OptionError:
                bases[method] = None
        model = factor_model(sensor, materials.training[::step], smooth, 3 * count)
        bases["factor model"] = model.projection
        for name, weights in bases.items():
            if weights is None or len(weights) != 3 * count:
                continue
            passes = fit_bands(Basis(weights), materials, LIGHTS)
            yield from rows_of(passes, passes=count, kind=name)


def point_weights(nm: Array) -> Array:
    """Weights (K, 81) of linear interpolation at wavelengths (K,) nm."""
    table = observer.grid()
    hats = [np.interp(nm, table, row) for row in np.eye(len(table))]
    return np.stack(hats, axis=1)


def by_light(chosen: dict[int, Passes], plain: Array) -> list[Row]:
    """Return mean errors by light, of RGB and of all passes."""
    rows = []
    for number, name in enumerate(LIGHTS):
        row = {"light": name, "rgb": plain[number].mean()}
        for count, passes in chosen.items():
            row[f"passes_{count}"] = passes.lights[number].errors.mean()
        rows.append(row)
    return rows


def other_lights(chosen: dict[int, Passes], materials: Materials) -> list[Row]:
    """Return mean errors under lights that no passes are fitted to."""
    rows = []
    for name in OTHER_LIGHTS:
        power = library.scaled_power(name)
        judged = draw_paths(
            materials.held_out, power[None], JUDGING_PATHS, JUDGING_SEED
        )
        row: Row = {"light": name}
        for count, passes in chosen.items():
            numbers = np.maximum(passes.light_numbers(power), 0)
            lit = judged.numbers(passes.bands.weights) * numbers
            row[f"passes_{count}"] = judged.errors((lit @ passes.to_xyz.T)[None]).mean()
        row["rgb"] = library.rgb_errors(materials, [name]).mean()
        rows.append(row)
    return rows


def without_family(name: str) -> Materials:
    """Return the library without a family, which is held out as a whole."""
    families = shipped_library()
    training = [family.measured for family in families if family.name != name]
    (held_out,) = [family.measured for family in families if family.name == name]
    return Materials(np.concatenate(training), held_out, {"source": "library"})


def left_out_families(counts: Sequence[int]) -> list[Row]:
    """Return the errors on families of which no material was known."""
    rows = []
    for family in shipped_library():
        materials = without_family(family.name)
        row: Row = {"family": family.name, "materials": len(family.measured)}
        for count in counts:
            passes = library.choose(materials, LIGHTS, count)
            row[f"passes_{count}"] = passes.error
        row["rgb"] = library.rgb_errors(materials, LIGHTS).mean()
        rows.append(row)
    return rows


def textures(chosen: dict[int, Passes]) -> list[Row]:
    """Return bytes and seconds of textures of passes, and of 31 wavelengths."""
    from uplift.extras import texture

    cube = uplift.load()
    source = sample_path(IMAGE)
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "texture.exr"

        def convert(*converters: object) -> tuple[int, float]:
            size = 0
            begin = time.perf_counter()
            for converter in converters:
                texture.convert(converter, source, target, force=True)
                size += target.stat().st_size
            return size, time.perf_counter() - begin

        spectrum = texture.Spectrum(tuple(np.arange(400.0, 701, 10).tolist()))
        kinds = {"31 wavelengths": [texture.prepare(cube, spectrum)]}
        for count, passes in chosen.items():
            numbers = range(1, count + 1)
            kinds[f"{count}"] = [
                library.prepare_pass(cube, passes, number) for number in numbers
            ]
        for name, converters in kinds.items():
            convert(*converters)  # compiles
            size, seconds = convert(*converters)
            rows.append({"kind": name, "bytes": size, "seconds": seconds})
    return rows


def write_page(passes: Passes) -> None:
    """Write the page of the room, and a picture of it after some frames."""
    path = DOCS / "passes" / "room.html"
    write_text(page(passes, chart().measured), path, force=True)
    with browser() as tab:
        tab.window(*WINDOW)
        tab.open(path)
        time.sleep(FRAMES_SECONDS)
        shot = tab.call("Page.captureScreenshot", format="jpeg", quality=85)
    path.with_suffix(".jpg").write_bytes(base64.b64decode(shot["data"]))


def main() -> None:
    """Measure, render, draw and store."""
    materials = library.library_materials()
    chosen, choices = measure_choices(materials)
    plain = library.rgb_errors(materials, LIGHTS)
    means = {str(count): plain.mean(axis=0)[count - 1] for count in range(1, 5)}
    room = passes_room.measure(DOCS / "passes")
    write_page(chosen[2])
    record(
        "passes",
        lights=LIGHTS,
        training=len(materials.training),
        held_out=len(materials.held_out),
        rgb={"bounces": means, "mean": plain.mean()},
        choices=choices,
        bases=list(other_bases(materials)),
        by_light=by_light(chosen, plain),
        other_lights=other_lights(chosen, materials),
        families=left_out_families((1, 2, 3)),
        textures=textures(chosen),
        image=IMAGE,
        **room,
    )
