"""What the papers did, kept to compare: other orders of growth, and other solvers."""
