"""The page of a design's tolerances."""
