"""Studies: what the choices of the design cost and gain, on atlases of one's own."""
