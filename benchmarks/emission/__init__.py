"""Emission tables: lamps left out, exactness, the map of expected errors, and cost."""
