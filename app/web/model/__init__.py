"""The page of a CAD model."""
