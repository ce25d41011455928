"""Effects of a design's tolerances on its results: limits, scatter, shares of the variance, and yields."""
