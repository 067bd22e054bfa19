"""The ColorChecker painted as RGB and rendered: ``make demo-render`` → docs/render.md."""
