"""Shared basics of all layers: arrays, errors, text, files in and out, progress, and
limits of the machine.
"""
