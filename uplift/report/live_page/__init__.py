"""Live page of a cube: relights an image in the browser, with the exported GLSL program."""

from __future__ import annotations

from uplift.report.live_page.page import write_page

__all__ = ["write_page"]
