"""What a scene needs: the smallest cube, the fewest wavelengths, the cheapest representation."""
