"""Published formulas as pure functions: SI or dimensionless arrays in and out."""
