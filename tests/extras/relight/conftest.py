"""Fixtures of the tests of textures."""

from tests.extras.texture.conftest import colours

__all__ = ["colours"]
