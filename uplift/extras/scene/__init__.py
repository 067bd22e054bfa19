"""Choices for the rendering of a scene: smallest cube, cheapest passes of an RGB
renderer, and advice on what to measure next.
"""
