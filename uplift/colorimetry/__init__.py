"""Colorimetry: sensors and lights, RGB spaces and gamuts, the solid of object colours,
ΔE and expected errors.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
