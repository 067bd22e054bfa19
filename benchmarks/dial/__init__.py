"""The light dial in a browser: ``make dial`` writes docs/palette-dial.md and the pictures in docs/palette-dial."""
