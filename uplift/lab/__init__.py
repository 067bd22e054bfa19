"""Measurements about methods: studies, the chart of speed against accuracy, comparisons."""
