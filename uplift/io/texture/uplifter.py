"""A cube prepared for textures of one pixel encoding."""

from __future__ import annotations

import json
from dataclasses import dataclass

from uplift.colorimetry.gamut import check_method
from uplift.colorimetry.spaces import find_space
from uplift.common.errors import OptionError
from uplift.io.slices import exr
from uplift.io.texture.colours import Counts, Floats, check_encoding
from uplift.io.texture.converter import Converter
from uplift.io.texture.pixel_encoding import PixelEncoding, Sampler, Spectrum
from uplift.lattice import Status
from uplift.lookup import Cube


@dataclass(frozen=True, eq=False)
class Uplifter(Converter):
    """A converter of colours to spectra, made by `prepare`, for any number of images.

    Parameters
    ----------
    sensor, depth, encoding, out_of_gamut, channels, header, space
        As in `Converter`. The header suffices to evaluate the spectra of a texture.
    cube : Cube
        The cube that uplifts.
    sample : callable
        From linear RGB (..., 3) to the numbers (..., N) of a pixel.
    rgb_error : callable or None
        From linear RGB (..., 3) to the largest error (..., 1) of the spectrum's colour. None if the cube has no
        unrealisable nodes.
    is_linear : bool
        Whether the numbers are linear in the spectrum.
    """

    cube: Cube
    sample: Sampler
    rgb_error: Sampler | None
    is_linear: bool

    def convert(self, rgb: Floats) -> tuple[tuple[Floats, ...], Counts]:
        """Uplift a block of colours.

        Parameters
        ----------
        rgb : ndarray of shape (..., 3)
            Linear RGB in [0, 1], float32.

        Returns
        -------
        tuple of ndarray
            R, G, B (..., 3), and the numbers (..., N) of the pixel encoding.
        Counts
            Pixels close to unrealisable colours.
        """
        return (rgb, self.sample(rgb)), self._unrealisable(rgb)

    def multiply(self, values: tuple[Floats, ...], opacity: Floats) -> tuple[Floats, ...]:
        """Multiply converted channels by alpha, multipliers excepted, as they are not linear in the spectrum.

        Parameters
        ----------
        values : tuple of ndarray
            What `convert` returns.
        opacity : ndarray of shape (..., 1)
            Alpha in [0, 1].

        Returns
        -------
        tuple of ndarray
            Arrays of the same shapes.
        """
        rgb, numbers = values
        return rgb * opacity, numbers * opacity if self.is_linear else numbers

    def _unrealisable(self, rgb: Floats) -> Counts:
        if self.rgb_error is None:
            return Counts()
        return Counts(unrealisable=int((self.rgb_error(rgb) > self.cube.data.threshold).sum()))


def prepare(
    cube: Cube,
    pixel_encoding: PixelEncoding | None = None,
    *,
    depth: str | None = None,
    encoding: str = "auto",
    out_of_gamut: str = "clip",
    space: str | None = None,
    threads: int = 2,
) -> Uplifter:
    """Prepare a cube for textures.

    Parameters
    ----------
    cube : Cube
        The cube.
    pixel_encoding : PixelEncoding, optional
        `Spectrum` (the default), `Moments` or `Multipliers`.
    depth : {"half", "float"}, optional
        Type of the channels, by default the smallest that is precise enough.
    encoding : {"auto", "linear", "encoded"}
        Interpretation of the numbers in images; ``auto`` takes integers as encoded, floats as linear.
    out_of_gamut : str
        Gamut mapping for pixels outside [0, 1], one of `uplift.colorimetry.gamut.METHODS`.
    space : str, optional
        RGB space of images, as for `uplift.colorimetry.spaces.find_space`, by default the one that each file states.
    threads : int
        Threads that share a band.

    Returns
    -------
    Uplifter
        The converter to pass to `convert`.

    Raises
    ------
    OptionError
        The depth is not precise enough (code ``unsupported-depth``), the cube has no moments, the wavelengths do
        not ascend, or the encoding or gamut mapping is unknown.
    UnknownNameError
        The RGB space is unknown.
    """
    pixels = Spectrum() if pixel_encoding is None else pixel_encoding
    depth = pixels.depths[0] if depth is None else depth
    if depth not in pixels.depths:
        raise OptionError(
            f"depth of {pixels.name} must be {' or '.join(pixels.depths)}, got '{depth}'",
            code="unsupported-depth",
            hint="other types are not precise enough",
        )
    check_encoding(encoding)
    check_method(out_of_gamut)
    channels = pixels.channels(cube)
    settings = {"depth": depth, "encoding": encoding, "out_of_gamut": out_of_gamut}
    settings |= {} if space is None else {"space": space}
    description = json.dumps({**pixels.describe(cube), **settings}, allow_nan=False)
    header = {**exr.attributes(cube.data), "uplift.texture": description, **pixels.header()}
    return Uplifter(
        cube.data.sensor,
        depth,
        encoding,
        out_of_gamut,
        channels,
        header,
        cube,
        sample=pixels.make_sampler(cube, threads),
        rgb_error=_rgb_error(cube, threads),
        is_linear=pixels.is_linear,
        space=None if space is None else find_space(space),
    )


def _rgb_error(cube: Cube, threads: int) -> Sampler | None:
    from uplift.lookup import bulk

    if not (cube.data.points.status == Status.UNREALISABLE).any():
        return None
    return bulk.max_rgb_error(cube, threads=threads)
