"""Looks: colours with given colours under other lights, and the bounds of what is
possible.
"""
