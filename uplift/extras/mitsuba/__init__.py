"""Plugins for the spectral variants of Mitsuba 3. They need the package mitsuba.

The texture ``uplift``:

``cube``
    file of the cube, found by Mitsuba's file resolver; the default cube of the package
    if omitted
``rgb``
    one colour: linear RGB of the cube's space, as three numbers or text
``filename``
    or an image: linear, or encoded in the cube's space if the file is; or a texture in
    OpenEXR that ``uplift texture`` wrote, which needs no cube
``bitmap``
    or an image as `mitsuba.Bitmap`
``out_of_gamut``
    treatment of colours outside [0, 1], one of `uplift.colorimetry.gamut.METHODS`;
    ``clip`` with a warning for images, ``error`` for one colour
``filter_type``
    ``bilinear``, ``nearest``, or ``stochastic``: one of the four texels around, chosen
    by its weight, which is faster and has the same mean
``wrap_mode``, ``to_uv``
    options of images, as in Mitsuba's ``bitmap``
``emission``
    whether the colours are of lights, for ``radiance`` of emitters; ``cube`` is then an
    emission table, and colours may have any brightness

The emitter ``uplift_envmap`` takes ``filename`` or ``bitmap``, ``cube``, ``to_world``
and ``scale``, as Mitsuba's ``envmap``. Images are uplifted when they are loaded, to 4
bytes per wavelength of the emission table and pixel; a spectral image of ``uplift
lights texture`` has the wavelengths that it was written with.

One colour becomes a regular spectrum of Mitsuba, without extra cost. Images are
uplifted when they are loaded, to the multipliers of each texel, 4 bytes per
coefficient. An image with colours near atlas entries has as many multipliers per texel
as the entries, any other as many as the nodes of the cube. Spectra are evaluated at the
wavelengths of each ray. docs/scene.md compares rates with Mitsuba's own textures.
Scalar variants call Python for every ray, and warn.

Examples
--------
::

    import mitsuba as mi
    from uplift.extras.mitsuba import register

    mi.set_variant("scalar_spectral")
    register()
    mi.load_dict({"type": "uplift", "cube": "paints.uplift", "rgb": [0.8, 0.2, 0.1]})
    mi.load_dict({"type": "uplift_envmap", "filename": "sky.exr"})
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
