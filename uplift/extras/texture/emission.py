"""Images of lights, such as environment maps, screens and textures of lamps, uplifted
by an emission table.
"""

import json
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.observer import sensor
from uplift.common.arrays import Array, Floats, Values
from uplift.common.errors import OptionError
from uplift.extras.emission.file import emission_digest
from uplift.extras.emission.lookup import MAX_VALUE, EmissionTable
from uplift.extras.images import exr
from uplift.extras.images.channels import BRIGHTEST, ColourChannels
from uplift.extras.images.converter import (
    Band,
    Converted,
    ImageConverter,
    RowConverter,
    resolve_depth,
)
from uplift.extras.images.counts import Counts
from uplift.extras.images.image import Part
from uplift.extras.images.reader import (
    NOT_FINITE,
    REPLACED,
    ReadColours,
    Reader,
    reads_codes,
)
from uplift.extras.texture.encodings import SPECTRAL_LAYOUT, spectral_channels
from uplift.lookup.blocks import as_wavelengths

DEPTHS = ("float", "half")
"""Types of channels, the default first."""
UNITS = "W.m^-2.sr^-1"
"""Units of emissive channels in the layout of Fichet et al. 2021."""
NOT_LIGHTS = "pixels-not-lights"
TOWARDS_WHITE = (
    "of colours that no light has: moved towards white of the same luminance"
)


@dataclass(frozen=True, eq=False, kw_only=True)
class LightReader(Reader):
    """Reader of lights, which have any brightness, for an emission table."""

    table: EmissionTable

    def channels(self, found: ColourChannels) -> ColourChannels:
        """Keep colours multiplied by alpha: a spectrum scales with its light, and light
        needs no opacity.
        """
        return replace(found, alpha=None)

    def decoder(self, part: Part) -> ReadColours:
        """Make the conversion of the numbers of a part to linear RGB of the table."""
        source = self.source_space(part)
        if self.encoding == "encoded" and not reads_codes(part, source):
            # A transfer function ends at 1, lights do not.
            hint = "leave out encoding='encoded', or name an encoded space"
            raise OptionError("floats of lights must be linear", hint=hint)
        matrix = None if source is None else source.matrix(self.table)
        to_linear = self.to_linear(part, source)

        def read(numbers: Values) -> tuple[Floats, Counts]:
            rgb = np.asarray(to_linear(numbers), dtype=float)
            usable = np.abs(rgb) <= MAX_VALUE  # NaN is not
            rgb = np.where(usable, rgb, np.where(rgb > 0, BRIGHTEST, 0.0))
            if matrix is not None:
                rgb = rgb @ matrix.T
            wrong = (~usable.all(axis=-1)).sum()
            counts = Counts(numbers.size // 3) + Counts.of(NOT_FINITE, wrong, REPLACED)
            return rgb.astype(np.float32, copy=False), counts

        return read


def light_reader(
    table: EmissionTable, encoding: str = "auto", space: str | None = None
) -> LightReader:
    """Return the reader of lights for a table."""
    colours = sensor(table.space)
    return LightReader(sensor=colours, encoding=encoding, space=space, table=table)


def light_power(
    table: EmissionTable, rgb: Floats, wavelengths: Array, threads: int
) -> tuple[Array, Floats, Counts]:
    """Return linear RGB (…, 3) that lights have, their power (…, N) at wavelengths
    (N,), and counts of the colours that no light has.
    """
    lights = rgb.astype(float)
    wrong = ~table.contains(lights)
    lights[wrong] = table.rgb(table.spectrum(lights[wrong], outside="clip"))
    power = table.spectrum(
        lights, wavelengths, outside="clip", dtype=np.float32, threads=threads
    )
    return lights, power, Counts.of(NOT_LIGHTS, wrong.sum(), TOWARDS_WHITE)


def prepare_lights(
    table: EmissionTable,
    wavelengths: ArrayLike | None = None,
    *,
    depth: str | None = None,
    encoding: str = "auto",
    space: str | None = None,
    threads: int = 2,
) -> RowConverter:
    """Prepare an emission table for images of lights.

    Parameters
    ----------
    table : EmissionTable
        The table.
    wavelengths : array_like, shape (N,), optional
        Ascending wavelengths in nm, by default those of the table.
    depth : {"float", "half"}, optional
        Type of the channels, by default ``float``; half floats end at 65504.
    encoding : {"auto", "linear", "encoded"}, default "auto"
        Interpretation of whole numbers; ``auto`` takes them as encoded. Floats are
        linear.
    space : str, optional
        RGB space of images, as for `uplift.extras.colour.spaces.find_space`, by default
        the one that each file states.
    threads : int, default 2
        Threads that share a band.

    Returns
    -------
    RowConverter
        The converter to pass to `convert`.

    Raises
    ------
    OptionError
        The depth or encoding is unknown, or the wavelengths do not ascend.
    UnknownNameError
        The RGB space is unknown.

    Examples
    --------
    >>> import uplift
    >>> from uplift.extras import texture
    >>> texture.prepare_lights(uplift.load_emission(), [450, 550]).channels
    ('S0.450,000000nm', 'S0.550,000000nm')
    """
    depth = resolve_depth(depth, DEPTHS, "lights")
    reader = light_reader(table, encoding, space)
    at = as_wavelengths(wavelengths, table.wavelengths)
    settings = {
        "as": "emission",
        "wavelengths": at.tolist(),
        "depth": depth,
        **reader.settings,
    }

    def rows(band: Band) -> Converted:
        lights, power, counts = light_power(table, band.rgb, at, threads)
        return (lights.astype(np.float32), power), counts

    return RowConverter(
        reader=reader,
        depth=depth,
        channels=spectral_channels("S0", at),
        header={
            "chromaticities": exr.chromaticities(reader.sensor),
            "uplift.cube": emission_digest(table.data),
            "uplift.texture": json.dumps(settings, allow_nan=False),
            "uplift.space": table.space,
            "uplift.observer": table.observer,
            **SPECTRAL_LAYOUT,
            "emissiveUnits": UNITS,
        },
        to_rows=ImageConverter(rows),
    )
