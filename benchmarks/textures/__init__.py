"""Accuracy, speed and memory of spectral textures: ``make textures``."""
