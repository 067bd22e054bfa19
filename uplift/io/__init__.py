"""Formats of other tools: textures, EXR slices, exports, Mitsuba."""
