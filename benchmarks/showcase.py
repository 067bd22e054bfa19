"""Pictures of the README and docs/materials.md, and their numbers.

The light on the charts is uniform, so that spectra are integrated
instead of rendered.
"""

import tempfile
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path

from PIL import Image

import uplift
from benchmarks import DOCS, Row, summary
from benchmarks.checker import BACKGROUND, LAYOUT, Place, chart, photo
from tests.examples import build_wheel, run_lines, unpack
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.colorimetry.observer import light, sensor
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.extras.colour.light_sets import DESCRIPTIONS, RELIGHT_LIGHTS
from uplift.extras.images.picture import read_picture
from uplift.extras.pages.figure import write_figure
from uplift.extras.pages.panels import Axis, Panel, draw, sheet
from uplift.extras.relight.relight import relight, write_relit_sheet
from uplift.lab.methods import mitsuba3
from uplift.samples import sample_path

FOLDER = DOCS / "showcase"
METHODS = MEASURED, PRODUCT, MITSUBA, PLAIN, ATLAS = (
    "measured",
    "RGB × light",
    "Mitsuba 3",
    "uplift, no atlas",
    "uplift, with the chart",
)
LIGHTS = tuple(map(light, RELIGHT_LIGHTS))
WIDTH = 2.2
"""Inches of a picture of the chart."""
JPEG_WIDTH = 1500
JPEG_QUALITY = 88
DIM = 32
SESSION = (
    "uplift samples",
    "cd uplift-samples",
    "uplift relight -o relit.html",
    "uplift build --atlas macbeth --dim 32",
    (
        "uplift query --cube macbeth-32.uplift '#da7b2a' --wavelengths 400:700:50 "
        "--plot "
        "orange.png"
    ),
)
"""Commands of the README."""


@cache
def cubes() -> dict[str, uplift.Cube]:
    """Return the cubes of the pictures."""
    return {PLAIN: uplift.load(), ATLAS: uplift.build("macbeth", dim=DIM)}


def session() -> list[dict[str, str]]:
    """Run the commands of the README in an empty folder; return all that they print."""
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        package = unpack(build_wheel(folder / "wheel"), folder / "package")
        for line in SESSION:
            outcomes = run_lines([line], package, folder)  # none of cd
            output = "".join(done["stderr"] + done["stdout"] for done in outcomes)
            rows.append({"command": line, "output": output.strip("\n")})
            if line.startswith("cd "):
                folder /= line.removeprefix("cd ")
    return rows


@cache
def spectra() -> dict[str, Array]:
    """Return the spectra (24, 81) of the patches, by method."""
    painted = chart()
    known = {
        MEASURED: painted.measured,
        MITSUBA: mitsuba3.spectra(painted.painted, painted.wavelengths),
    }
    for name, cube in cubes().items():
        known[name] = cube.reflectance(painted.painted)
    return known


def patches(lamp: Light) -> dict[str, tuple[Array, Array]]:
    """Return XYZ (24, 3) of the patches under a light, and their ΔE00, by method."""
    srgb = sensor()
    xyz = {name: values @ lamp.xyz.T for name, values in spectra().items()}
    xyz[PRODUCT] = srgb.xyz(chart().painted * (srgb.xyz_to_rgb @ lamp.white))
    in_lab = {name: lab(xyz[name], lamp.white) for name in METHODS}
    truth = in_lab[MEASURED]
    return {name: (xyz[name], delta_e_2000(truth, in_lab[name])) for name in METHODS}


def means() -> Iterator[Row]:
    """Draw the chart by all methods, and by two; yield the errors of its patches, of
    all and of those inside sRGB.

    Patches have a measured square by all methods, and a measured left half by two.
    """
    draw_sheet("charts.png", METHODS, LIGHTS, LAYOUT.middles())
    methods = (MEASURED, PRODUCT, ATLAS)
    draw_sheet("truth.png", methods, LIGHTS[:2], LAYOUT.halves())
    inside = ~chart().outside
    for lamp in LIGHTS:
        for name, (_, errors) in patches(lamp).items():
            if name != MEASURED:
                of = {"method": name, "light": lamp.name}
                yield {**of, "patches": "all", **summary(errors)}
                yield {**of, "patches": "inside sRGB", **summary(errors[inside])}


def draw_sheet(
    file: str, methods: Sequence[str], lamps: Sequence[Light], places: Sequence[Place]
) -> None:
    """Draw the chart by methods under lights, with the measured one in places."""
    rows = {}
    for lamp in lamps:
        known = patches(lamp)
        background = BACKGROUND * lamp.white
        truth = LAYOUT.paint(known[MEASURED][0], background)
        to_screen = sensor(illuminant=lamp.name).xyz_to_rgb.T
        panels = []
        for name in methods:
            xyz, errors = known[name]
            image = LAYOUT.paint(xyz, background)
            for place in places:
                image[place] = truth[place]
            text = f"mean ΔE00 {errors.mean():.1f}, largest {errors.max():.1f}"
            caption = "" if name == MEASURED else text
            panels.append(Panel([photo(image @ to_screen)], x=Axis(caption)))
        rows[f"{lamp.name}\n{DESCRIPTIONS[lamp.name]}"] = panels
    figure = draw(sheet(methods, rows), len(methods), WIDTH)
    write_figure(figure, FOLDER / file, force=True)


def still_life() -> None:
    """Draw what ``uplift relight`` shows, as JPEG."""
    path = sample_path("still-life.png")
    picture = read_picture(path, sensor(), max_side=960)
    shown = {
        "spectral": cubes()[PLAIN],
        "spectral with macbeth": cubes()[ATLAS],
    }
    relit = relight(path.name, picture.rgb, shown)
    with tempfile.TemporaryDirectory() as folder:
        png = Path(folder) / "relit.png"
        write_relit_sheet([relit], png)
        with Image.open(png) as image:
            size = (JPEG_WIDTH, round(image.height * JPEG_WIDTH / image.width))
            small = image.convert("RGB").resize(size, Image.Resampling.LANCZOS)
    small.save(FOLDER / "relit.jpg", quality=JPEG_QUALITY, subsampling=0)


QUESTIONS = {"session": session, "means": means, "still_life": still_life}
