"""Images under other lights, by products of RGB and by spectra: figures, a page, and
OpenEXR at full size. How images are read and written is not here, but in
`uplift.extras.images`.
"""
