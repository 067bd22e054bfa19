"""Gamut mapping of colours outside sRGB: hue shifts, lightness, times, and a picture."""
