"""Import of colour-science on first use."""

import functools
import warnings
from types import ModuleType

import numpy as np


@functools.cache
def colour_science() -> ModuleType:
    """Import colour-science, which takes a second, without its warnings about optional
    dependencies.

    The print options of numpy, which it changes, are restored.
    """
    with warnings.catch_warnings(), np.printoptions():
        warnings.simplefilter("ignore")
        import colour
    return colour
