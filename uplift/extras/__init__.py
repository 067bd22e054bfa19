"""Designing spectra: palettes of lights and materials, and pigment mixing."""
