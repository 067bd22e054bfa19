"""Programs that measure and write docs/data/*.json; `make docs` renders the pages."""
