"""Plans for real textures, and whether what they predict is so."""
