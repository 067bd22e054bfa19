"""A still life of measured materials, relit from one photograph and from two, for
docs/guides/two-lights.md and the README.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from benchmarks import DOCS, Row
from benchmarks.materials import SENSOR, Materials, other_halves
from benchmarks.still_life import BALLS, MATERIALS, still_life
from uplift.colorimetry import delta_e_spectra, observer, rgb_to_lab
from uplift.colorimetry.gamut import SRGB
from uplift.common.arrays import Array, Indices, Mask
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.pages.figure import (
    ACCENT,
    GREY,
    INK,
    colour_map,
    new_figure,
    show_image,
    style_axes,
    write_png,
)
from uplift.extras.photographs import Noise, photograph, prepare

SET = "cie2017"
DIM = 32
SECOND = "A"
NOISE = Noise(0.005, 0.0005)
RELIT = ("FL11", "HP1")
NAMES = {"FL11": "three-band tubes (FL11)", "HP1": "a sodium lamp (HP1)"}
FOLDER = DOCS / "two-lights"
LARGEST = 5.0
"""ΔE00 at the end of the scale of maps."""
QUANTILE = 0.95
INCHES = 2.7
"""Width of a panel."""
TITLE = 0.25
"""Height of its title."""


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
    write_png(draw_page(scene), FOLDER / "scene.png", force=True)
    write_png(draw_readme(scene), FOLDER / "sodium.png", force=True)
    errors = {}
    for name, (one, two) in scene.errors.items():
        errors[name] = {"one": summary(one), "two": summary(two)}
    return {
        "set": SET,
        "materials": MATERIALS,
        "share": NOISE.share,
        "floor": NOISE.floor,
        "second": SECOND,
        "errors": errors,
    }


def summary(delta_e: Array) -> Row:
    """Return mean and 95 % of ΔE00."""
    return {"mean": delta_e.mean(), "p95": np.quantile(delta_e, QUANTILE)}


def draw_page(scene: Scene) -> Any:
    """Draw both photographs, and the picture under further lights with its errors."""
    figure, panels = grid(scene, 1 + 2 * len(RELIT))
    show(panels[0, 0], scene.first, "photograph in daylight (D65)")
    show(panels[0, 1], scene.second, f"photograph in tungsten light ({SECOND})")
    draw_spectra(panels[0, 2], scene)
    for number, light in enumerate(RELIT):
        draw_light(panels[1 + 2 * number : 3 + 2 * number], scene, light)
    draw_scale(figure, panels[2, 0])
    return figure


def draw_readme(scene: Scene) -> Any:
    """Draw the picture under one further light with its errors."""
    figure, panels = grid(scene, 2)
    draw_light(panels, scene, RELIT[-1])
    draw_scale(figure, panels[1, 0])
    return figure


def grid(scene: Scene, rows: int) -> tuple[Any, Any]:
    """Create a figure with rows of three panels."""
    height, width = scene.first.shape[:2]
    panel = INCHES * height / width + TITLE
    figure = new_figure(3 * INCHES, rows * panel)
    return figure, figure.subplots(rows, 3)


def show(axes: Any, rgb: Array, title: str) -> None:
    """Draw linear sRGB (H, W, 3), white to white."""
    show_image(axes, to_display_codes(rgb, SRGB).astype(np.uint8))
    axes.set_title(title, fontsize=8, loc="left", pad=3)


def draw_light(panels: Any, scene: Scene, light: str) -> None:
    """Draw the picture under a light in the first row of panels, and the errors of the
    answers below.
    """
    shown = observer.sensor(illuminant=light)
    versions = {
        f"{NAMES[light]}: measured": scene.measured,
        "from one photograph": scene.one,
        "from both photographs": scene.two,
    }
    for axes, (title, spectra) in zip(panels[0], versions.items(), strict=True):
        show(axes, shown.rgb(spectra), title)
    panels[1, 0].set_axis_off()
    for axes, errors in zip(panels[1, 1:], scene.errors[light], strict=True):
        show_image(axes, errors, cmap=colour_map(), vmin=0, vmax=LARGEST)
        title = f"ΔE00: {errors.mean():.1f} on average"
        axes.set_title(title, fontsize=8, loc="left", pad=3)


def draw_spectra(axes: Any, scene: Scene) -> None:
    """Draw the spectra of the ball that one photograph misses most, the means of its
    pixels.
    """
    one, _ = scene.errors[RELIT[-1]]
    missed = [one[ball].mean() for ball in scene.balls]
    ball = scene.balls[int(np.argmax(missed))]
    at = SENSOR.wavelengths
    axes.plot(at, scene.measured[ball].mean(axis=0), color=INK, label="measured")
    axes.plot(at, scene.one[ball].mean(axis=0), color=GREY, ls=":", label="one")
    axes.plot(at, scene.two[ball].mean(axis=0), color=ACCENT, ls="--", label="both")
    axes.set_title("reflectance of a ball, over nm", fontsize=8, loc="left", pad=3)
    axes.set_xticks([400, 500, 600, 700])
    axes.tick_params(labelsize=7)
    axes.set_ylim(bottom=0)
    axes.legend(fontsize=7, frameon=False)
    style_axes(axes)


def draw_scale(figure: Any, axes: Any) -> None:
    """Draw the scale of the maps of errors in an empty panel."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    shades = ScalarMappable(Normalize(0, LARGEST), colour_map())
    place = axes.inset_axes((0.12, 0.45, 0.76, 0.08))
    bar = figure.colorbar(shades, cax=place, orientation="horizontal", extend="max")
    bar.set_label("ΔE00", fontsize=8)
    bar.ax.tick_params(labelsize=8)
