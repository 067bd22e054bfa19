"""Looks: colours with given colours under other lights, and the bounds of what is
possible.

What photographs under several lights decide is in `uplift.extras.photographs`, the
page on which a look is chosen in `uplift.extras.report`.
"""
