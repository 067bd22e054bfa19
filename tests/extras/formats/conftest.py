"""Fixtures of the tests of atlases."""

from tests.atlas.conftest import save

__all__ = ["save"]
