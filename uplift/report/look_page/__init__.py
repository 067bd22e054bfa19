"""A page to choose a look on: drag the colour of an RGB under other lights, and its spectrum follows."""

from __future__ import annotations

from uplift.report.look_page.page import write_look_page

__all__ = ["write_look_page"]
