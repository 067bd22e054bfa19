"""Photographs under several lights: spectra of materials that have one RGB, and
differ: answers that several photographs decide, and samples where nothing does.

Textures from their pictures are in `uplift.extras.texture`.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
