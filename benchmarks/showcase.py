"""The pictures of the README and their numbers, for docs/materials.md.

The light on the charts is uniform, so that spectra are integrated
instead of rendered; docs/scene.md has renderings of the same chart, which agree.
"""

import io
import tempfile
import warnings
from pathlib import Path

import numpy as np
from PIL import Image

import uplift
from benchmarks import DOCS, record
from benchmarks.checker import BACKGROUND, Layout, chart, draw
from tests.examples import build_wheel, run_lines, unpack
from uplift.colorimetry import Light, delta_e_2000, lab
from uplift.colorimetry.lights import DESCRIPTIONS, RELIGHT_LIGHTS
from uplift.colorimetry.observer import light, sensor
from uplift.common.arrays import Array
from uplift.common.files import atomic_write
from uplift.lab.chart import mitsuba3
from uplift.report.relight import relight, write_relit_sheet
from uplift.samples import sample_path

FOLDER = DOCS / "showcase"
MEASURED, PRODUCT, MITSUBA, PLAIN, ATLAS = (
    "measured",
    "RGB × light",
    "Mitsuba 3",
    "uplift, no atlas",
    "uplift, with the chart",
)
LAYOUT = Layout(patch=32, gap=4)
SIZE = (11.2, 5.2)
JPEG_WIDTH, JPEG_QUALITY = 1500, 88
DIM = 32
SESSION = (
    "uplift samples",
    "uplift relight -o relit.html",
    "uplift build --atlas macbeth --dim 32",
    "uplift query --cube macbeth-32.uplift '#da7b2a' --wavelengths 400:700:50 --plot orange.png",
)
"""Commands of the README."""


def main() -> None:
    """Draw both pictures and store the numbers of the first."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    FOLDER.mkdir(exist_ok=True)
    lamps = [light(name) for name in RELIGHT_LIGHTS]
    methods, inside = colours(lamps)
    errors = {
        (lamp.name, name): delta_e_2000(lab(values[MEASURED], lamp.white), lab(values[name], lamp.white))
        for lamp, values in zip(lamps, methods, strict=True)
        for name in values
    }
    draw_charts(lamps, methods, errors)
    draw_still_life()
    record(
        "showcase",
        session=session(),
        dim=DIM,
        lights=[{"light": lamp.name, "what": DESCRIPTIONS[lamp.name]} for lamp in lamps],
        means=[
            {
                "method": name,
                **{
                    lamp.name: {
                        "all": float(errors[lamp.name, name].mean()),
                        "inside": float(errors[lamp.name, name][inside].mean()),
                        "max": float(errors[lamp.name, name].max()),
                    }
                    for lamp in lamps
                },
            }
            for name in (PRODUCT, MITSUBA, PLAIN, ATLAS)
        ],
    )


def session() -> list[dict[str, str]]:
    """Run the commands of the README in an empty folder and return what they print on standard output."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        outcomes = run_lines(SESSION, unpack(build_wheel(folder / "wheel"), folder / "package"), folder)
    return [{"command": each["line"], "output": each["stdout"].strip("\n")} for each in outcomes]


def colours(lamps: list[Light]) -> tuple[list[dict[str, Array]], Array]:
    """Return XYZ (24, 3) of the patches by method for each lamp, and which patches lie inside sRGB."""
    painted = chart()
    cube = uplift.build("macbeth", dim=DIM)
    srgb = cube.data.sensor
    spectra = {
        MEASURED: painted.measured,
        MITSUBA: mitsuba3.spectra(painted.painted, painted.wavelengths),
        PLAIN: uplift.load().reflectance(painted.painted),
        ATLAS: cube.reflectance(painted.painted),
    }
    found = []
    for lamp in lamps:
        xyz = {name: values @ lamp.xyz.T for name, values in spectra.items()}
        product = painted.painted * (srgb.xyz_to_rgb @ lamp.white)
        found.append({MEASURED: xyz.pop(MEASURED), PRODUCT: srgb.xyz(product), **xyz})
    return found, ~painted.outside


def draw_charts(lamps: list[Light], methods: list[dict[str, Array]], errors: dict[tuple[str, str], Array]) -> None:
    """Draw the charts; the squares inside the patches are the measured colours."""
    width, height = LAYOUT.size
    images = {}
    captions = {}
    for lamp, values in zip(lamps, methods, strict=True):
        row = f"{lamp.name}, {DESCRIPTIONS[lamp.name]}"
        for name, xyz in values.items():
            image = np.full((height, width, 3), BACKGROUND) * lamp.white
            for place, colour in zip(LAYOUT.patches(), xyz, strict=True):
                image[place] = colour
            images[lamp.name, name] = image
            mean = errors[lamp.name, name].mean()
            captions[lamp.name, name] = row if name == MEASURED else f"mean ΔE00 {mean:.1f}"
    to_screen = {lamp.name: sensor(illuminant=lamp.name).xyz_to_rgb for lamp in lamps}
    draw(images, captions, to_screen, tuple(methods[0]), LAYOUT, FOLDER / "charts.png", SIZE)


def draw_still_life() -> None:
    """Draw what ``uplift relight`` shows, as JPEG."""
    from uplift.io.texture.picture import read_picture

    cubes = {"spectral": uplift.load(), "spectral with macbeth": uplift.build("macbeth", dim=DIM)}
    path = sample_path("still-life.png")
    picture = read_picture(path, cubes["spectral with macbeth"].data.sensor, max_side=960)
    relit = relight(path.name, picture.rgb, cubes)
    with tempfile.TemporaryDirectory() as folder:
        png = Path(folder) / "relit.png"
        write_relit_sheet([relit], png)
        with Image.open(png) as image:
            size = (JPEG_WIDTH, round(image.height * JPEG_WIDTH / image.width))
            small = image.convert("RGB").resize(size, Image.Resampling.LANCZOS)
    buffer = io.BytesIO()
    small.save(buffer, "JPEG", quality=JPEG_QUALITY, subsampling=0)
    with atomic_write(FOLDER / "relit.jpg", force=True) as temporary:
        temporary.write_bytes(buffer.getvalue())
