"""Contact sheets: all slices of constant blue of a cube on one image."""

from __future__ import annotations

from uplift.viz.sheet.write_sheet import check_sheet, write_sheet

__all__ = ["check_sheet", "write_sheet"]
