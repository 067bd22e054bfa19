"""The order of a build: options in, cube out; and the repetition of a
recorded build.
"""
