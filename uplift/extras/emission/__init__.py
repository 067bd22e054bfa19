"""Emission tables: spectra of lights by their colours, from measured lamps over a
lattice of chromaticities u′v′.

Names of illuminants are in `uplift.colorimetry`, images of lights in
`uplift.extras.texture`, and tables as programs in `uplift.extras.export`.
"""
