"""Images: files are read and written, and one conversion leads from the colours of an
image to the channels of another.

`open_image` reads parts and rows of OpenEXR, Radiance HDR, PNG, JPEG and TIFF, upright
and as they are stored; `Reader` turns their numbers into linear RGB of a sensor, by the
colour space that the file states or the caller names; `convert` applies a `Converter`
band by band and writes OpenEXR. Which numbers a pixel gets (spectra, colours under
other lights, passes, coats of paint) is not here: each room has its converters. Cubes
are written as slices.
"""
