"""The light dial in a browser: ``make dial`` writes docs/palette-dial.md and docs/palette-dial/page.png."""
