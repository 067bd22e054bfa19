"""Colours as people state them, and as answers describe them: RGB spaces of pictures,
8-bit codes, sets of lights, cameras, queries in full detail.
"""
