"""Spectral pictures from an RGB renderer: three bands of wavelengths a pass, and a
matrix that decodes the pictures of all passes (docs/guides/passes.md).

Examples
--------
::

    from uplift.extras.scene import passes

    materials = passes.library_materials()
    chosen = passes.choose(materials, ["D65", "A"], count=2)
    passes.write_passes(chosen, "passes.toml")
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
