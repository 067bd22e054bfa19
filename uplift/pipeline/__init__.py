"""The order of a build: options in, cube out; and a recorded build repeated."""

from __future__ import annotations

from uplift.pipeline.build_cube import build

__all__ = ["build"]
