"""Studies: what the choices behind the models are worth, measured on atlases."""
