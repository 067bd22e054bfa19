"""A still life of measured materials, relit from one photograph and from two, for
docs/guides/two-lights.md and the README.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from benchmarks import DOCS, Row, summary
from benchmarks.materials import SENSOR, Materials, other_halves
from benchmarks.still_life import BALLS, MATERIALS, still_life
from uplift.colorimetry import delta_e_spectra, observer, rgb_to_lab
from uplift.colorimetry.gamut import SRGB
from uplift.common.arrays import Array, Indices, Mask
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.pages.figure import ACCENT, GREY, write_figure
from uplift.extras.pages.marks import error_map, line, picture
from uplift.extras.pages.panels import Axis, Panel, draw
from uplift.extras.photographs import Noise, photograph, prepare

SET = "cie2017"
DIM = 32
SECOND = "A"
NOISE = Noise(0.005, 0.0005)
RELIT = ("FL11", "HP1")
NAMES = {"FL11": "tubes (FL11)", "HP1": "sodium lamp (HP1)"}
FOLDER = DOCS / "two-lights"
LARGEST = 5.0
"""ΔE00 at the end of the scale of maps."""
INCHES = 2.5
"""Width of a panel."""


@dataclass(frozen=True, eq=False)
class Scene:
    """Reflectances (H, W, 81) of a picture, its photographs (H, W, 3) under two lights,
    and the answers (H, W, 81) to one photograph and to both; the pixels (H, W) of each
    ball.
    """

    balls: list[Mask]

    measured: Array
    first: Array
    second: Array
    one: Array
    two: Array

    @cached_property
    def errors(self) -> dict[str, tuple[Array, Array]]:
        """ΔE00 (H, W) of both answers under each light."""
        return {
            name: (
                difference(name, self.one, self.measured),
                difference(name, self.two, self.measured),
            )
            for name in RELIT
        }


def difference(light: str, first: Array, second: Array) -> Array:
    """ΔE00 (H, W) under a light between reflectances (H, W, 81)."""
    flat = [spectra.reshape(-1, spectra.shape[-1]) for spectra in (first, second)]
    return delta_e_spectra(observer.light(light), *flat).reshape(first.shape[:2])


def choose(known: Materials, count: int) -> Indices:
    """Choose materials whose colours are far from each other: each is the farthest from
    those before. The lightest greys come last.
    """
    lab = rgb_to_lab(SENSOR, known.rgb)
    chosen = [int(np.linalg.norm(lab - lab.mean(axis=0), axis=1).argmin())]
    apart = np.full(len(lab), np.inf)
    for _ in range(count - 1):
        apart = np.minimum(apart, np.linalg.norm(lab - lab[chosen[-1]], axis=1))
        chosen.append(int(apart.argmax()))
    lightness, a, b = lab[chosen].T
    return np.array(chosen)[np.argsort(lightness - np.hypot(a, b))]


def take_photographs() -> Scene:
    """Photograph materials that a cube does not know, and answer the photographs."""
    cube, unseen = other_halves(SET, dim=DIM)[0]
    materials = unseen.take(choose(unseen, MATERIALS))
    weights = still_life()
    balls = [weights[..., ball] > 0 for ball in range(len(BALLS))]
    measured = weights @ materials.measured
    random = np.random.default_rng(0)
    further = photograph(SENSOR, SECOND)
    photographs = prepare(cube, [further], NOISE)
    first = np.clip(with_noise(SENSOR.rgb(measured), random), 0, 1)
    second = with_noise(measured @ further.matrix.T, random)
    one = cube.reflectance(first)
    two = photographs.reflectance(first, second)
    return Scene(balls, measured, first, second, one, two)


def with_noise(values: Array, random: np.random.Generator) -> Array:
    """Return values of a photograph with noise."""
    normal = random.standard_normal(values.shape)
    return values + np.sqrt(NOISE.variance(values)) * normal


def draw_pictures() -> Row:
    """Draw the picture of the page and that of the README; return their numbers."""
    scene = take_photographs()
    FOLDER.mkdir(exist_ok=True)
    page = draw(page_panels(scene), 3, INCHES)
    readme = draw(relit_panels(scene, RELIT[-1]), 3, INCHES)
    write_figure(page, FOLDER / "scene.png", force=True)
    write_figure(readme, FOLDER / "sodium.png", force=True)
    errors = {}
    for name, (one, two) in scene.errors.items():
        errors[name] = {"one": summary(one.ravel()), "two": summary(two.ravel())}
    return {
        "set": SET,
        "materials": MATERIALS,
        "share": NOISE.share,
        "floor": NOISE.floor,
        "second": SECOND,
        "errors": errors,
    }


def page_panels(scene: Scene) -> list[Panel | None]:
    """Return both photographs, and the picture under further lights with its errors."""
    panels = [
        photo(scene.first, "photograph in daylight (D65)"),
        photo(scene.second, f"photograph in tungsten light ({SECOND})"),
        missed_ball(scene),
    ]
    for light in RELIT:
        panels += relit_panels(scene, light)
    return panels


def photo(rgb: Array, title: str) -> Panel:
    """Return a panel of linear sRGB (H, W, 3), white to white."""
    return Panel([picture(to_display_codes(rgb, SRGB).astype(np.uint8))], title)


def relit_panels(scene: Scene, light: str) -> list[Panel | None]:
    """Return the picture under a light, and the errors of the answers below."""
    shown = observer.sensor(illuminant=light)
    versions = {
        f"{NAMES[light]}: measured": scene.measured,
        "from one photograph": scene.one,
        "from both photographs": scene.two,
    }
    panels: list[Panel | None] = []
    for title, spectra in versions.items():
        panels.append(photo(shown.rgb(spectra), title))
    panels.append(None)
    for errors in scene.errors[light]:
        marks = [error_map(errors, LARGEST)]
        panels.append(Panel(marks, f"ΔE00: {errors.mean():.1f} on average"))
    return panels


def missed_ball(scene: Scene) -> Panel:
    """Return the spectra of the ball that one photograph misses most, the means of its
    pixels.
    """
    one, _ = scene.errors[RELIT[-1]]
    missed = [one[ball].mean() for ball in scene.balls]
    ball = scene.balls[int(np.argmax(missed))]
    at = SENSOR.wavelengths
    marks = [
        line(at, scene.measured[ball].mean(axis=0), "measured"),
        line(at, scene.one[ball].mean(axis=0), "one", GREY, linestyle=":"),
        line(at, scene.two[ball].mean(axis=0), "both", ACCENT, linestyle="--"),
    ]
    x = Axis(ticks=(400, 500, 600, 700))
    title = "reflectance of a ball, over nm"
    return Panel(marks, title, x, Axis(limits=(0, None)), legend="best")
