"""Representations of spectra held against one another: colours, cost, filters, advice, tables and pictures."""
