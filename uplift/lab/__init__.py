"""Measurements of methods: `runner` queries those of `methods` for measured materials
under lights; studies, the chart of speed against accuracy, comparisons of
representations.
"""
