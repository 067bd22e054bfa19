"""Queries of a cube with numpy alone: neither the fit, JAX nor colour-science is
imported.
"""
