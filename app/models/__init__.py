"""CAD models on their own: build, artifacts, verify."""
