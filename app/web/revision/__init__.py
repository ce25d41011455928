"""The page of a revision."""
