"""A still life of measured materials, relit from one photograph and from two, for
docs/guides/two-lights.md and the README.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from benchmarks import DOCS, Row, summary
from benchmarks.checker import photo
from benchmarks.materials import SENSOR, other_halves
from benchmarks.still_life import BALLS, MATERIALS, still_life
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra, rgb_to_lab
from uplift.common.arrays import Array, Indices, Mask
from uplift.extras.pages.figure import ACCENT, GREY, INK, write_figure
from uplift.extras.pages.marks import error_map, line
from uplift.extras.pages.panels import Axis, Panel, draw
from uplift.extras.photographs.answers import Photographs, prepare
from uplift.extras.photographs.photograph import Noise, photograph
from uplift.lookup.cube import Cube

SET = "cie2017"
DIM = 32
SECOND = "A"
NOISE = Noise(0.005, 0.0005)
RELIT = {"FL11": "tubes (FL11)", "HP1": "sodium lamp (HP1)"}
FOLDER = DOCS / "two-lights"
LARGEST = 5.0
"""ΔE00 at the end of the scale of maps."""
INCHES = 2.5
"""Width of a panel."""
MEASURED = "measured"
ANSWERS = ONE, BOTH = "from one photograph", "from both photographs"


@dataclass(frozen=True, eq=False)
class Scene:
    """Photographs (H, W, 3) under two lights, the reflectances (H, W, 81) that were
    measured and that are answered, and the pixels (H, W, B) of the balls.
    """

    first: Array
    second: Array
    spectra: dict[str, Array]
    balls: Mask

    def errors(self, light: str, answer: str) -> Array:
        """ΔE00 (H, W) of an answer under a light."""
        pair = self.spectra[answer], self.spectra[MEASURED]
        return delta_e_spectra(observer.light(light), *pair)


def choose(rgb: Array, count: int) -> Indices:
    """Choose colours (n, 3) that are far from each other: each is the farthest from
    those before. The lightest greys come last.
    """
    lab = rgb_to_lab(SENSOR, rgb)
    chosen = [int(np.linalg.norm(lab - lab.mean(axis=0), axis=1).argmin())]
    apart = np.full(len(lab), np.inf)
    for _ in range(count - 1):
        apart = np.minimum(apart, np.linalg.norm(lab - lab[chosen[-1]], axis=1))
        chosen.append(int(apart.argmax()))
    lightness, a, b = lab[chosen].T
    return np.array(chosen)[np.argsort(lightness - np.hypot(a, b))]


def take_photographs(
    cube: Cube, measured: Array, further: Sequence[str], noise: Noise, seed: int
) -> tuple[Photographs, Array, Array]:
    """Photograph reflectances (..., 81) with noise; return what answers photographs,
    linear RGB under the light of the cube, and the numbers under further lights.
    """
    photographs = prepare(cube, [photograph(SENSOR, name) for name in further], noise)
    random = np.random.default_rng(seed)

    def noisy(values: Array) -> Array:
        normal = random.standard_normal(values.shape)
        return values + np.sqrt(noise.variance(values)) * normal

    rgb = np.clip(noisy(SENSOR.rgb(measured)), 0, 1)
    return photographs, rgb, noisy(measured @ photographs.matrix.T)


def make_scene() -> Scene:
    """Photograph materials that a cube does not know, and answer the photographs."""
    cube, task = next(other_halves(SET, dim=DIM))
    weights = still_life()
    measured = weights @ task.queried[choose(task.rgb, MATERIALS)]
    photographs, first, second = take_photographs(cube, measured, [SECOND], NOISE, 0)
    spectra = {
        MEASURED: measured,
        ONE: cube.reflectance(first),
        BOTH: photographs.reflectance(first, second),
    }
    return Scene(first, second, spectra, weights[..., : len(BALLS)] > 0)


def draw_pictures() -> Iterator[Row]:
    """Draw the picture of the page and that of the README; yield their errors."""
    scene = make_scene()
    panels = [
        Panel([photo(scene.first)], "photograph in daylight (D65)"),
        Panel([photo(scene.second)], f"photograph in tungsten light ({SECOND})"),
        missed_ball(scene),
    ]
    for light in RELIT:
        relit = relit_panels(scene, light)
        panels += relit
    write_figure(draw(panels, 3, INCHES), FOLDER / "scene.png", force=True)
    write_figure(draw(relit, 3, INCHES), FOLDER / "sodium.png", force=True)
    for light, answer in product(RELIT, ANSWERS):
        errors = scene.errors(light, answer)
        yield {"light": light, "answer": answer, **summary(errors.ravel())}


def relit_panels(scene: Scene, light: str) -> list[Panel | None]:
    """Return the picture under a light, and the errors of the answers below."""
    shown = observer.sensor(illuminant=light)
    panels: list[Panel | None] = []
    for name, spectra in scene.spectra.items():
        title = f"{RELIT[light]}: {name}" if name == MEASURED else name
        panels.append(Panel([photo(shown.rgb(spectra))], title))
    panels.append(None)
    for answer in ANSWERS:
        errors = scene.errors(light, answer)
        marks = [error_map(errors, LARGEST)]
        panels.append(Panel(marks, f"ΔE00: {errors.mean():.1f} on average"))
    return panels


def missed_ball(scene: Scene) -> Panel:
    """Return the spectra of the ball that one photograph misses most, the means of its
    pixels.
    """
    errors = scene.errors("HP1", ONE)
    missed = [errors[ball].mean() for ball in np.moveaxis(scene.balls, -1, 0)]
    ball = scene.balls[..., np.argmax(missed)]
    curves = {
        MEASURED: ("measured", INK, "-"),
        ONE: ("one", GREY, ":"),
        BOTH: ("both", ACCENT, "--"),
    }
    marks = []
    for name, (label, colour, dashes) in curves.items():
        mean = scene.spectra[name][ball].mean(axis=0)
        marks.append(line(SENSOR.wavelengths, mean, label, colour, linestyle=dashes))
    x = Axis(ticks=(400, 500, 600, 700))
    title = "reflectance of a ball, over nm"
    return Panel(marks, title, x, Axis(limits=(0, None)), legend="best")
