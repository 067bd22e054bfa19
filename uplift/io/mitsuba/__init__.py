"""Cubes in Mitsuba 3: the texture ``uplift``, for its spectral variants. Needs the extra ``uplift[mitsuba]``.

    import mitsuba as mi
    from uplift.io.mitsuba import register

    mi.set_variant("scalar_spectral")
    register()
    mi.load_dict({"type": "uplift", "cube": "paints.uplift", "rgb": [0.8, 0.2, 0.1]})

=============  ==========================================================================================
``cube``       the cube's file, sought as Mitsuba seeks files; by default the package's own
``rgb``        one colour: linear RGB of the cube's space, as three numbers or text
``filename``   or an image: encoded as the cube's space has it where the file is, linear where it is not
``bitmap``     or an image as `mitsuba.Bitmap`
``filter_type``, ``wrap_mode``, ``to_uv``   of images, as Mitsuba's ``bitmap`` has them
=============  ==========================================================================================

One colour becomes a spectrum of Mitsuba's own, so it costs nothing. Images are uplifted when they are loaded, to the
multipliers of each texel, 4 bytes a coefficient; spectra are evaluated where rays ask. That is as fast as Mitsuba's own
textures in the JIT variants; scalar ones call Python for every ray, some thousand times a second.
"""

from __future__ import annotations

from uplift.io.mitsuba.plugin import register

__all__ = ["register"]
