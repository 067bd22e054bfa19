"""The order of a build: options in, cube out; and the repetition of a recorded build."""

from __future__ import annotations

from uplift.pipeline.build_cube import build
from uplift.pipeline.look import Look
from uplift.pipeline.provenance import recorded_atlas
from uplift.pipeline.rebuild import rebuild

__all__ = ["Look", "build", "rebuild", "recorded_atlas"]
