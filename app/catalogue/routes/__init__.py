"""Routes of the catalogue: templates, the library, and faults of files."""
