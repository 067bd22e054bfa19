"""Tables of spectra: where wavelengths, values, labels and text are in a
grid of cells.
"""
