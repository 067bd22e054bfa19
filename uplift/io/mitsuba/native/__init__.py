"""The texture in C++ for scalar variants, where a texture in Python is called for every ray."""

from __future__ import annotations

from uplift.io.mitsuba.native.compile import compile_plugin, find_plugin
from uplift.io.mitsuba.native.properties import native_properties

__all__ = ["compile_plugin", "find_plugin", "native_properties"]
