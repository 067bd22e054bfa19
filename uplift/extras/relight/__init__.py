"""Images under other lights: as figures, as a page, and at full size."""
