"""Colour: sensors, illuminants, sRGB, ΔE, gamut mapping, and the object-colour solid."""
