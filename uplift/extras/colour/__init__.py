"""Colours as people state them, and as answers describe them: colours in words and
files, RGB spaces of pictures, 8-bit codes, sets of lights, cameras, queries in full
detail.

The colorimetry of spectra is in `uplift.colorimetry`, pictures are in
`uplift.extras.images`.
"""
