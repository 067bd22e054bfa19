"""Atlases of measured reflectances: readers of many formats, writers of two, and
resampling.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
