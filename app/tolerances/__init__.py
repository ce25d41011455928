"""What the tolerances of a design do to its results: limits, scatter, shares and yields."""
