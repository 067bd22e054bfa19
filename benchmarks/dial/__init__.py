"""The relighting viewer in a browser: frame rates and pictures."""
