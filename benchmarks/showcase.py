"""Pictures of the README and docs/materials.md, and their numbers.

The light on the charts is uniform, so that spectra are integrated
instead of rendered.
"""

import tempfile
from functools import cache
from pathlib import Path

from PIL import Image

import uplift
from benchmarks import DOCS, Row, summary
from benchmarks.checker import BACKGROUND, Layout, chart, draw
from tests.examples import build_wheel, run_lines, unpack
from uplift.colorimetry import delta_e_2000, lab
from uplift.colorimetry.observer import light, sensor
from uplift.extras.colour.light_sets import RELIGHT_LIGHTS
from uplift.extras.relight.relight import relight, write_relit_sheet
from uplift.extras.texture.picture import read_picture
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
LAYOUT = Layout(patch=32, gap=4)
TRUTH_LIGHTS = RELIGHT_LIGHTS[:2]
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


def means() -> list[Row]:
    """Draw the chart by all methods, and by two; return the errors of its patches, of
    all and of those inside sRGB.

    Patches have a measured square by all methods, and a measured left half by two.
    """
    painted = chart()
    srgb = sensor()
    spectra = {
        MEASURED: painted.measured,
        MITSUBA: mitsuba3.spectra(painted.painted, painted.wavelengths),
        **{name: cube.reflectance(painted.painted) for name, cube in cubes().items()},
    }
    images = {}
    errors = {}
    to_screen = {}
    rows = []
    for lamp in map(light, RELIGHT_LIGHTS):
        to_screen[lamp.name] = sensor(illuminant=lamp.name).xyz_to_rgb
        xyz = {name: values @ lamp.xyz.T for name, values in spectra.items()}
        xyz[PRODUCT] = srgb.xyz(painted.painted * (srgb.xyz_to_rgb @ lamp.white))
        truth = lab(xyz[MEASURED], lamp.white)
        for name in METHODS:
            delta_e = delta_e_2000(truth, lab(xyz[name], lamp.white))
            of = {"method": name, "light": lamp.name}
            rows.append({**of, "patches": "all", **summary(delta_e)})
            inside = summary(delta_e[~painted.outside])
            rows.append({**of, "patches": "inside sRGB", **inside})
            errors[lamp.name, name] = delta_e
            images[lamp.name, name] = LAYOUT.paint(xyz[name], BACKGROUND * lamp.white)
    FOLDER.mkdir(exist_ok=True)
    picture = FOLDER / "charts.png"
    draw(images, errors, to_screen, METHODS, LAYOUT.middles(), picture)
    shown = {name: to_screen[name] for name in TRUTH_LIGHTS}
    methods = (MEASURED, PRODUCT, ATLAS)
    picture = FOLDER / "truth.png"
    draw(images, errors, shown, methods, LAYOUT.halves(), picture)
    return [row for row in rows if row["method"] != MEASURED]


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
