"""Methods of three documents, each a room: spectral representations (Kment 2011),
wavelengths of a renderer (Meyer 1988), and palettes (Bergner, Möller & Drew 2004).

Searches for a scene's cheapest cube, and passes of an RGB renderer, which use them, are
in `uplift.extras.scene`.
"""
