"""Contact sheets: all slices of constant blue of a cube, or the diagrams of an emission table, on one image."""

from __future__ import annotations

from uplift.viz.sheet.write_sheet import check_sheet, write_light_sheet, write_sheet

__all__ = ["check_sheet", "write_light_sheet", "write_sheet"]
