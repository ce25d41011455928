"""The page of the designs that a changed file affects."""
