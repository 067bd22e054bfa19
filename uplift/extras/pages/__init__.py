"""Figures, contact sheets, HTML pages and formatting of numbers, shared by the packages
above the core.
"""
