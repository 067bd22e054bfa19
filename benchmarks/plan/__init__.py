"""Scene plans for real textures, and the accuracy of their predictions."""
