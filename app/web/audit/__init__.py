"""The page of recorded changes."""
