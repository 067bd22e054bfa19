"""Images under other lights: products of RGB and spectra, as one picture or as a page with a slider."""

from __future__ import annotations

from uplift.report.relight.page import write_relit_page
from uplift.report.relight.relight import RGB_PRODUCT, Difference, Relit, Rendering, relight
from uplift.report.relight.sheet import write_relit_sheet

__all__ = [
    "RGB_PRODUCT",
    "Difference",
    "Relit",
    "Rendering",
    "relight",
    "write_relit_page",
    "write_relit_sheet",
]
