"""Choices for the rendering of a scene: smallest cube, cheapest passes of an RGB
renderer, and advice on what to measure next.

The representations and wavelengths that plans choose from are in
`uplift.extras.papers`, textures in `uplift.extras.texture`.
"""
