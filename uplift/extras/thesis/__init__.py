"""What the papers did, kept to compare: other orders of growth, and other solvers."""

from uplift.extras.thesis.growth_coarse import grow_coarse_to_fine
from uplift.extras.thesis.growth_neighbours import grow_from_neighbours
from uplift.extras.thesis.stock_solvers import as_method

__all__ = ["as_method", "grow_coarse_to_fine", "grow_from_neighbours"]
