"""The page of the designs that a new version affects."""
