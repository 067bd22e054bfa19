"""Formats of other tools: textures, EXR slices, exports for other programs, Mitsuba;
child processes.
"""
