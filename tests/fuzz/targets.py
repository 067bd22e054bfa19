"""All fuzz targets by name."""

from __future__ import annotations

from tests.fuzz import commands, cubes, images, texts

READERS = {target.name: target for module in (texts, cubes, images) for target in module.TARGETS}
COMMANDS = {target.name: target for target in commands.TARGETS}
