"""``make representations``: ways to hold spectra, on the shipped atlases and beside the thesis."""
