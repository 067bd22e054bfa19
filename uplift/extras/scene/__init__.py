"""Choices for the rendering of a scene: smallest cube, fewest wavelengths, cheapest
representation, quadrature.
"""
