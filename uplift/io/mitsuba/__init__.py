"""The texture plugin ``uplift`` for the spectral variants of Mitsuba 3. Extra: ``spectral-uplift[mitsuba]``.

=======================================  ======================================================================
``cube``                                 file of the cube, found by Mitsuba's file resolver; the default cube of
                                         the package if omitted
``rgb``                                  one colour: linear RGB of the cube's space, as three numbers or text
``filename``                             or an image: linear, or encoded in the cube's space if the file is
``bitmap``                               or an image as `mitsuba.Bitmap`
``filter_type``, ``wrap_mode``,          options of images, as in Mitsuba's ``bitmap``
``to_uv``
=======================================  ======================================================================

One colour becomes a regular spectrum of Mitsuba, without extra cost. Images are uplifted when they are loaded, to the
multipliers of each texel, 4 bytes per coefficient. An image with colours near atlas entries has as many multipliers per
texel as the entries, any other as many as the nodes of the cube. Spectra are evaluated at the wavelengths of each ray.
In the JIT variants this is as fast as Mitsuba's own textures. Scalar variants call Python for every ray, some thousand
times per second.

Examples
--------
::

    import mitsuba as mi
    from uplift.io.mitsuba import register

    mi.set_variant("scalar_spectral")
    register()
    mi.load_dict({"type": "uplift", "cube": "paints.uplift", "rgb": [0.8, 0.2, 0.1]})
"""

from __future__ import annotations

from uplift.io.mitsuba.plugin import register

__all__ = ["register"]
