"""Spectrum models: families of reflectance spectra in (0, 1), one per file, behind the
interface `Model`.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
