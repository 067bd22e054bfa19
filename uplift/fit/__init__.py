"""The fit: atlas entries, prior, seeds, then growth, improvement and storage of the
nodes.
"""
