"""The catalogue: templates and their versions."""
