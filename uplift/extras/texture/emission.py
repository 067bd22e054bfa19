"""An emission table prepared for images of lights: environment maps, screens, textures
of lamps.
"""

import json
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.observer import sensor
from uplift.common.arrays import Array, Floats, Values
from uplift.common.errors import OptionError
from uplift.extras.colour.spaces import find_space
from uplift.extras.emission.file import emission_digest
from uplift.extras.emission.lookup import MAX_VALUE, EmissionTable
from uplift.extras.images import exr
from uplift.extras.texture import colours, uplifter
from uplift.extras.texture.channels import BRIGHTEST, ColourChannels
from uplift.extras.texture.image import Part
from uplift.lookup.blocks import as_wavelengths

DEPTHS = ("float", "half")
"""Types of channels, the default first."""
UNITS = "W.m^-2.sr^-1"
"""Units of emissive channels in the layout of Fichet et al. 2021."""


@dataclass(frozen=True, eq=False)
class LightUplifter(uplifter.Converter):
    """A converter of the colours of lights to power at ``wavelengths`` (N,) nm, made by
    `prepare_lights`.
    """

    table: EmissionTable
    wavelengths: Array
    threads: int

    def colour_channels(self, found: ColourChannels) -> ColourChannels:
        # Colours stay multiplied by alpha: a spectrum scales with its light, and light
        # needs no opacity.
        return replace(found, alpha=None)

    def decoder(self, part: Part) -> uplifter.ReadColours:
        source = colours.source_space(part, self.sensor, self.space)
        if self.encoding == "encoded" and not colours.reads_codes(part, source):
            # A transfer function ends at 1, lights do not.
            hint = "leave out encoding='encoded', or name an encoded space"
            raise OptionError("floats of lights must be linear", hint=hint)
        matrix = None if source is None else source.matrix(self.table)
        to_linear = colours.linear_reader(self.sensor, part, self.encoding, source)

        def read(numbers: Values) -> tuple[Floats, colours.Counts]:
            rgb = np.asarray(to_linear(numbers), dtype=float)
            usable = np.abs(rgb) <= MAX_VALUE  # NaN is not
            rgb = np.where(usable, rgb, np.where(rgb > 0, BRIGHTEST, 0.0))
            if matrix is not None:
                rgb = rgb @ matrix.T
            changed = int((~usable.all(axis=-1)).sum())
            return rgb.astype(np.float32, copy=False), colours.Counts(
                numbers.size // 3, not_finite=changed
            )

        return read

    def convert(self, rgb: Floats) -> uplifter.Converted:
        lights, wrong = self._of_lights(rgb)
        counts = colours.Counts(not_lights=wrong)
        return (lights.astype(np.float32), self._power(lights)), counts

    def power(self, rgb: Floats) -> tuple[Floats, colours.Counts]:
        """Return the power (…, N) of lights of linear RGB (…, 3), and counts of colours
        that no light has.
        """
        lights, wrong = self._of_lights(rgb)
        return self._power(lights), colours.Counts(not_lights=wrong)

    def _of_lights(self, rgb: Floats) -> tuple[Array, int]:
        """Return linear RGB (…, 3) that lights have, and the number of changed ones."""
        lights = rgb.astype(float)
        wrong = ~self.table.contains(lights)
        clipped = self.table.spectrum(lights[wrong], outside="clip")
        lights[wrong] = self.table.rgb(clipped)
        return lights, int(wrong.sum())

    def _power(self, lights: Array) -> Floats:
        return self.table.spectrum(
            lights,
            self.wavelengths,
            outside="clip",
            dtype=np.float32,
            threads=self.threads,
        )


def prepare_lights(
    table: EmissionTable,
    wavelengths: ArrayLike | None = None,
    *,
    depth: str | None = None,
    encoding: str = "auto",
    space: str | None = None,
    threads: int = 2,
) -> LightUplifter:
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
    LightUplifter
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
    depth = uplifter.resolve_depth(depth, DEPTHS, "lights")
    colours.check_encoding(encoding)
    at = as_wavelengths(wavelengths, table.wavelengths)
    channels = uplifter.spectral_channels("S0", at)
    settings = {
        "as": "emission",
        "wavelengths": at.tolist(),
        "depth": depth,
        "encoding": encoding,
    }
    settings |= {} if space is None else {"space": space}
    colour_space = sensor(table.space)
    header = {
        "chromaticities": exr.chromaticities(colour_space),
        "uplift.cube": emission_digest(table.data),
        "uplift.texture": json.dumps(settings, allow_nan=False),
        "uplift.space": table.space,
        "uplift.observer": table.observer,
        **uplifter.SPECTRAL_LAYOUT,
        "emissiveUnits": UNITS,
    }
    chosen = None if space is None else find_space(space)
    return LightUplifter(
        colour_space,
        depth,
        encoding,
        "clip",
        channels,
        header,
        table,
        at,
        threads,
        space=chosen,
    )
