"""Published formulas as pure functions that take and return arrays, in SI units or dimensionless."""
