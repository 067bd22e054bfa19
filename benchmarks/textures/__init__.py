"""What textures are worth: ``make textures`` writes docs/textures.md and docs/textures/relit.png."""
