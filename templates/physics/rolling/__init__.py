"""Rolling bearings: rating life."""
