"""What the papers did, kept to compare: other orders of growth, and other solvers.

The order and the solver that builds use are in `uplift.fit`.
"""
