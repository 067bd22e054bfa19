"""Rates and accuracy of exported programs."""
