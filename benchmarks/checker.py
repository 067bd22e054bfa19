"""The ColorChecker: measured spectra and painted RGB, as a picture and as a Mitsuba
scene.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import MACBETH, Row
from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry import in_unit_cube, observer
from uplift.colorimetry.gamut import SRGB
from uplift.common.arrays import Array
from uplift.extras.colour.light_sets import DESCRIPTIONS
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.pages.figure import new_figure, show_image, write_png

COLUMNS = 6
ROWS = 4
BACKGROUND = 0.03
"""Reflectance between the patches."""
VARIANT = "scalar_spectral"
"""The spectral variant that does not need LLVM."""
OF_SURFACES = {"type": "direct", "bsdf_samples": 1, "emitter_samples": 0}
"""Integrator for uniform illumination, where only the wavelengths are random."""
CIE_Y_INTEGRAL = 106.856895
"""Mitsuba divides by it, so that a constant radiance of 1 has Y = 1."""
DPI = 160
Place = tuple[slice, slice]
"""Rows and columns of a part of a picture."""
Reflectances = list[Row]
"""Textures of Mitsuba for the patches."""


@dataclass(frozen=True, eq=False)
class Chart:
    """24 patches: ``measured`` (24, N) reflectances at ``wavelengths`` (N,) nm,
    ``painted`` (24, 3) linear sRGB.

    ``outside`` (24,) marks the colours outside sRGB, which are painted clipped.
    """

    names: tuple[str, ...]
    wavelengths: Array
    measured: Array
    painted: Array
    outside: Array


def chart() -> Chart:
    """Read the shipped ColorChecker."""
    sensor = observer.sensor()
    atlas = read_atlas(MACBETH)
    measured = on_grid(atlas, sensor.wavelengths)
    rgb = sensor.rgb(measured)
    painted = np.clip(rgb, 0, 1)
    outside = ~in_unit_cube(rgb)
    return Chart(atlas.names, sensor.wavelengths, measured, painted, outside)


@dataclass(frozen=True)
class Layout:
    """Patches of ``patch`` pixels in reading order, ``gap`` between and around them."""

    patch: int
    gap: int

    @property
    def pitch(self) -> int:
        """Distance from a patch to the next."""
        return self.patch + self.gap

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture."""
        return COLUMNS * self.pitch + self.gap, ROWS * self.pitch + self.gap

    def corners(self) -> Iterator[tuple[int, int]]:
        """Yield the top left pixel (x, y) of each patch."""
        for row, column in np.ndindex(ROWS, COLUMNS):
            yield self.gap + column * self.pitch, self.gap + row * self.pitch

    def patches(self, inset: int = 0) -> Iterator[Place]:
        """Yield the rows and columns of each patch, ``inset`` pixels from its edges."""
        for corner in self.corners():
            columns, rows = (
                slice(start + inset, start + self.patch - inset) for start in corner
            )
            yield rows, columns

    def middles(self) -> list[Place]:
        """Return the rows and columns of a square in the middle of each patch."""
        return list(self.patches(round(0.3 * self.patch)))

    def halves(self) -> list[Place]:
        """Return the rows and columns of the left half of each patch."""
        width = self.patch // 2
        return [
            (rows, slice(columns.start, columns.start + width))
            for rows, columns in self.patches()
        ]

    def paint(self, colours: Array, background: Array) -> Array:
        """Return an image (height, width, 3) of patches (24, 3) on a background."""
        width, height = self.size
        image = np.tile(background, (height, width, 1))
        for place, colour in zip(self.patches(), colours, strict=True):
            image[place] = colour
        return image

    def means(self, image: Array) -> Array:
        """(24, K) mean of each patch in an image (height, width, K)."""
        return np.array([image[place].mean(axis=(0, 1)) for place in self.patches()])


def draw(
    images: Mapping[tuple[str, str], Array],
    delta_e: Mapping[tuple[str, str], Array],
    to_screen: Mapping[str, Array],
    methods: Sequence[str],
    reference: Sequence[Place],
    path: Path,
    size: tuple[float, float],
) -> None:
    """Draw XYZ ``images`` by light and method, with the first method in the places
    ``reference`` of all.

    ``delta_e`` has the errors of the patches, ``to_screen`` the matrices (3, 3) from
    XYZ to linear sRGB by light.
    """
    figure = new_figure(*size)
    figure.set_dpi(DPI)
    grid = figure.subplots(len(to_screen), len(methods), squeeze=False)
    for row, (name, matrix) in enumerate(to_screen.items()):
        for column, method in enumerate(methods):
            axes = grid[row, column]
            image = images[name, method].copy()
            for place in reference:
                image[place] = images[name, methods[0]][place]
            height, width, _ = image.shape
            # Means of 2 × 2 pixels halve the noise.
            binned = image.reshape(height // 2, 2, width // 2, 2, 3).mean(axis=(1, 3))
            show_srgb(axes, binned @ matrix.T)
            if column:
                errors = delta_e[name, method]
                text = f"mean ΔE00 {errors.mean():.1f}, largest {errors.max():.1f}"
                axes.set_xlabel(text, fontsize=9, color="0.3")
            if row == 0:
                axes.set_title(method, fontsize=11, pad=8)
            if column == 0:
                axes.set_ylabel(f"{name}\n{DESCRIPTIONS[name]}", fontsize=9, labelpad=8)
    write_png(figure, path, force=True)


def show_srgb(axes: Any, rgb: Array) -> None:
    """Show linear sRGB (height, width, 3), a pixel a sample."""
    codes = to_display_codes(rgb, SRGB).astype(np.uint8)
    show_image(axes, codes, interpolation="nearest")


def start_mitsuba(variant: str = VARIANT) -> str:
    """Select the variant and register the plug-ins; return Mitsuba's version."""
    import mitsuba

    from uplift.extras.mitsuba import register

    mitsuba.set_variant(variant)
    register()
    return str(mitsuba.__version__)


def measured_spectra(painted: Chart) -> Reflectances:
    """Return the measured spectra of the patches: the reference."""
    return [regular_spectrum(painted.wavelengths, row) for row in painted.measured]


def constant_light(illuminant: str) -> Row:
    """Return uniform illumination, as bright as makes white's Y = 1."""
    sensor = observer.sensor(illuminant=illuminant)
    step = sensor.wavelengths[1] - sensor.wavelengths[0]
    luminous = (sensor.power * sensor.cmfs[:, 1]).sum() * step
    radiance = sensor.power * CIE_Y_INTEGRAL / luminous
    spectrum = regular_spectrum(sensor.wavelengths, radiance)
    return {"type": "constant", "radiance": spectrum}


def regular_spectrum(wavelengths: Array, values: Array) -> Row:
    """Describe samples with straight lines between them."""
    return {
        "type": "regular",
        "wavelength_min": float(wavelengths[0]),
        "wavelength_max": float(wavelengths[-1]),
        "values": ", ".join(f"{value:.9g}" for value in values),
    }


def render(
    emitter: Row,
    reflectances: Reflectances,
    layout: Layout,
    spp: int,
    seed: int,
) -> Array:
    """Return XYZ (height, width, 3) of the chart under an emitter, from straight above,
    a unit a pixel.
    """
    import mitsuba as mi

    transform = mi.ScalarTransform4f
    width, height = layout.size

    def square(reflectance: Row, middle: list[float], scale: list[float]) -> Row:
        return {
            "type": "rectangle",
            "to_world": transform().translate(middle).scale(scale),
            "bsdf": {"type": "diffuse", "reflectance": reflectance},
        }

    half = layout.patch / 2
    patches = {}
    for reflectance, (x, y) in zip(reflectances, layout.corners(), strict=True):
        middle = [x + half - width / 2, height / 2 - y - half, 0]
        name = f"patch_{len(patches)}"
        patches[name] = square(reflectance, middle, [half, half, 1])
    view = transform().look_at(origin=[0, 0, 100], target=[0, 0, 0], up=[0, 1, 0])
    camera = {
        "type": "orthographic",
        "to_world": view @ transform().scale([width / 2, width / 2, 1]),
        "film": xyz_film(width, height) | {"rfilter": {"type": "box"}},
    }
    scene = {
        "type": "scene",
        "integrator": OF_SURFACES,
        "light": emitter,
        "camera": camera,
        "background": square(
            {"type": "uniform", "value": BACKGROUND}, [0, 0, -1e-3], [width, height, 1]
        ),
        **patches,
    }
    return np.array(mi.render(mi.load_dict(scene), spp=spp, seed=seed), dtype=float)


def xyz_film(width: int, height: int) -> Row:
    """Describe a film of XYZ."""
    return {
        "type": "hdrfilm",
        "width": width,
        "height": height,
        "pixel_format": "xyz",
        "component_format": "float32",
    }
