"""Queries of a cube with numpy alone: neither the fit, JAX nor colour-science is
imported.
"""

from uplift.lookup.cube import Cube, load
from uplift.lookup.interpolate import MODES

__all__ = ["MODES", "Cube", "load"]
