"""Measurements of methods: studies, the chart of speed against accuracy, comparisons of
representations.
"""
