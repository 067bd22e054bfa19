"""Figures, contact sheets, HTML pages and formatting of numbers, shared by the rooms
above the core.

What a figure or a page shows is not here, but in the room that it is about.
"""
