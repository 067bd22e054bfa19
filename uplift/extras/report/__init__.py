"""Quality of a cube: assessment by its lattice and by measured spectra, as data, JSON
and HTML page; other pages.
"""
