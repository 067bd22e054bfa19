"""Fixtures of the tests of atlases."""

from tests.atlas.conftest import read, save

__all__ = ["read", "save"]
