"""The content of a cube, and the file that stores it."""
