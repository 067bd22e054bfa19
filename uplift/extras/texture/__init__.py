"""Spectral textures: images whose pixels are uplifted and written as OpenEXR
(docs/textures.md).

Examples
--------
::

    import uplift
    from uplift.extras import texture

    uplifter = texture.prepare(uplift.load("macbeth.uplift"), texture.Moments())
    texture.convert(uplifter, "wood.png", "wood.exr")
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
