"""Files of people: CSV, TOML and JSON, and what a program checks before it writes."""
