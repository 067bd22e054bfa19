"""Speed against accuracy: every method of spectral upsampling on the same colours and measured spectra."""
