"""What becomes of colours that no screen shows: ``make display`` writes docs/display.md and its picture."""
