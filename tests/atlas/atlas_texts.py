"""Entries as text, for the atlas tests."""

from pathlib import Path

ATLASES = Path(__file__).parents[2] / "atlases"

THESIS = """\
Entry ID:\torange
<hr/>\t
Description\t: "orange" patch of the Macbeth colour checker
Type\t: reflectance spectrum
Fluorescence data\t: no
Measurement device\t:
Measured by\t:
Measurement date\t:
<hr/>\t
Sampling information\t
<hr/>\t
Type\t: regular
Start\t: 380.0 nm
Increment\t: 5.0 nm
Maximum sample value\t: 100.0
<hr/>\t
ASCII sample data\t
<hr/>\t
{6.143748, 5.192119, 4.867970, 5.092529, 4.717562, 4.663087, 4.455331, \
4.562958, 4.517197, \
4.536289, 4.454180, 4.543101, 4.491708, ... }
"""
"""Tódová 2020, figure 3.1, character by character."""

ORANGE = THESIS.replace("... }", ", ".join(["50"] * 68) + "}")
"""The same, with samples up to 780 nm where the figure ends."""

PLAIN = """\
Entry ID:   grey
---------------------------------------------------------------------------
Description           :  a grey card
Type                  :  reflectance spectrum
Fluorescence data     :  no
Measurement device    :  spectrometer
Measured by           :  A. Person
Measurement date      :  2020-01-31
Sampling information
--------------------
Type                  :  regular
Start                 :  400.0 nm
Increment             :  100.0 nm
Maximum sample value  :  1.0
ASCII sample data
-----------------
{0.5, 0.25, 0.125, 0.0625}

"""
"""An entry of four samples; its sample list stands on line 17."""
