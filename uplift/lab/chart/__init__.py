"""Speed against accuracy: methods of spectral upsampling on the same colours and
measured spectra.
"""
