"""Comparison of spectral representations for renderers: errors, cost, filters,
recommendations and pictures.
"""
