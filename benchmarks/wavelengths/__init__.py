"""``make wavelengths``: Meyer's figures derived anew, and what few wavelengths cost → docs/wavelengths.md."""
