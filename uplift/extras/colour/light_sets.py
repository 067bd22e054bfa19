"""Sets of illuminants for each purpose, by the names of colour-science."""

REPORT_LIGHTS = ("D65", "A", "FL2", "FL7", "FL11", "LED-B3")
"""Lights of reports and of the study of moments."""

RELIGHT_LIGHTS = ("A", "FL11", "HP1")
"""Lights under which products of RGB go visibly wrong: warm, three narrow bands, and
nearly one wavelength.
"""

DESCRIPTIONS = {
    "A": "tungsten", "D50": "warm daylight", "D65": "daylight", "HP1": "sodium lamp",
    "FL2": "fluorescent", "FL7": "broadband fluorescent",
    "FL11": "three-band fluorescent",
    "LED-B3": "white LED", "LED-RGB1": "red, green and blue LED",
}  # fmt: skip
"""Words for readers who do not know the names."""

CHART_LIGHTS = REPORT_LIGHTS[1:]
"""Lights of the chart of methods: all of a report but the illuminant that colours are
matched under.
"""

HELD_OUT_LIGHTS = (*CHART_LIGHTS, "LED-RGB1", "HP1")
"""Lights of errors on held-out measurements, which include extreme spectra."""

REGRESSION_LIGHTS = ("D65", "A", "FL11")
"""Lights of the regression check of stored cubes: smooth, reddish, and three narrow
bands.
"""

PALETTE_LIGHTS = ("D65", "A", "D50", "E")
"""Smooth lights that the standard factor model of palettes is fitted to."""

NARROW_BAND_LIGHT = "FL11"
"""Light of the sensitivity study: its narrow bands expose differences between spectra.
"""

KMENT_LIGHTS = {"smooth": ("A", "B", "C"), "spiky": ("FL2", "FL7", "FL11")}
"""Sets of lights of Kment 2011, 5.4: non-fluorescent and fluorescent."""

STANDARD_ILLUMINANTS = ("A", "D50", "D55", "D65", "D75")
"""Illuminants that an emission table without an atlas returns exactly."""
