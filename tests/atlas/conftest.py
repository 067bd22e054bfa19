"""Fixtures of the atlas tests."""

from collections.abc import Callable
from pathlib import Path

import pytest

from uplift.atlas.atlas import Atlas
from uplift.atlas.sources import read_atlas


@pytest.fixture
def save(tmp_path: Path) -> Callable[..., Path]:
    """Write text or bytes to a file in a temporary folder."""

    def save(content: str | bytes, name: str = "atlas.txt") -> Path:
        path = tmp_path / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return save


@pytest.fixture
def read(save: Callable[..., Path]) -> Callable[..., Atlas]:
    """Read text or bytes as an atlas."""
    return lambda *args: read_atlas(save(*args))
