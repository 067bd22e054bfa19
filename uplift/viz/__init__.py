"""Figures, contact sheets, HTML and number formatting, for every layer above the core."""
