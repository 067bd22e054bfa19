"""How a renderer may hold spectra: one representation a file, all behind `Representation`."""
