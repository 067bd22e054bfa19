"""Mixing models: criteria, accuracy of the assumed scattering, times and pictures."""
