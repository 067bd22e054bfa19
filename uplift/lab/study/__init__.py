"""Studies of the choices behind the models, one module per study.

`moments` compares techniques and numbers of moments, `held_out` predicts held-out
measurements, `stability` looks for builds that fail, and `sensitivity` perturbs queries
and atlases. The modules load JAX, so the package imports none.
"""
