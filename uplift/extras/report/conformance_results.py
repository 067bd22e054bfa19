"""Results of other programs for the chart of the conformance kit: a picture, or a table
of spectra.
"""

import numpy as np

from uplift.colorimetry.gamut import SRGB
from uplift.common.arrays import Array, StrPath
from uplift.common.errors import ColourError, TextureError
from uplift.extras.images.channels import coloured_parts
from uplift.extras.images.image import open_image
from uplift.extras.report.answers import read_answers
from uplift.extras.report.conformance_chart import COLUMNS, COUNT, ROWS, Chart

SPECTRA = (400.0, 700.0, 10.0)
"""First and last wavelength and step of tables of spectra in nm."""
MAX_PATCH = 64
"""Largest number of pixels along a side of a patch."""
ROUNDING = 1e-5
"""Linear RGB by which rows of spectra may differ from the colours of the chart."""


def spectra_wavelengths() -> Array:
    """Return the wavelengths (31,) of tables of spectra in nm."""
    start, end, step = SPECTRA
    return np.arange(start, end + step / 2, step)


def read_patches(path: StrPath) -> Array:
    """Read a picture of the chart. Returns mean XYZ (1000, 3) of the middles of the
    patches. Raises `TextureError`.
    """
    with open_image(path) as image:
        part, channels = coloured_parts(image)[0]
        if part.max_code:
            raise TextureError(
                f"a picture of the chart must have floats, got {part.types[0]}",
                hint="write linear RGB as OpenEXR",
            )
        window = part.window
        side = window.width // COLUMNS
        size = (side * COLUMNS, side * ROWS)
        if not 1 <= side <= MAX_PATCH or (window.width, window.height) != size:
            raise TextureError(
                f"the picture must have {COLUMNS} × {ROWS} patches of 1 to {MAX_PATCH} "
                f"pixels, got {window.width} × {window.height} pixels",
                hint="render the scene of the kit as it is",
            )
        bands = [band[..., channels.rgb] for _, band in image.bands(part)]
    pixels = np.concatenate(bands).astype(float)
    if not np.isfinite(pixels).all():
        count = np.count_nonzero(~np.isfinite(pixels).all(axis=-1))
        raise TextureError(
            f"pixels must be finite, got {count} that are not",
            path=path,
            hint="look for divisions by zero in the renderer",
        )
    # Filters blur the edges of patches.
    middle = slice(side // 4, side - side // 4)
    patches = pixels.reshape(ROWS, side, COLUMNS, side, 3)[:, middle, :, middle]
    rgb = patches.mean(axis=(1, 3)).reshape(COUNT, 3)
    if channels.is_xyz:
        return rgb
    stated = None if part.profile is None else part.profile.space
    gamut = SRGB if stated is None else stated.gamut
    return np.asarray(rgb @ gamut.rgb_to_xyz.T)


def read_spectra(path: StrPath, chart: Chart) -> Array:
    """Read reflectances (1000, 31) of the colours of a chart. Raises `ColourError`."""
    expected = spectra_wavelengths()
    answers = read_answers(path, expected)
    hint = "compute the rows of colours.csv, in their order"
    if answers.rgb.shape != chart.rgb.shape:
        problem = f"must have {COUNT:,} rows, got {len(answers.rgb):,}"
        raise ColourError(problem, path=path, hint=hint)
    moved = np.abs(answers.rgb - chart.rgb).max(axis=1) > ROUNDING
    if moved.any():
        raise ColourError(
            "must have the colours of the chart of the cube",
            path=path,
            line=int(moved.argmax()) + 2,
            hint=hint,
        )
    if not np.array_equal(answers.wavelengths, expected):
        text = f"{expected[0]:g}, {expected[1]:g}, … {expected[-1]:g}"
        problem = f"must have the wavelengths {text} nm"
        raise ColourError(problem, path=path, hint="name a column by each")
    return answers.reflectance
