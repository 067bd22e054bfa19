"""Tables, JSON, CSV and progress on the terminal."""
