"""Selection of wavelengths, and reproduction of Meyer 1988: ``make wavelengths``."""
