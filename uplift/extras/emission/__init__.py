"""Emission tables: lights as colours, measured lamps, and a lattice over the
chromaticities u′v′.
"""
