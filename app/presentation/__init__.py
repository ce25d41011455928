"""Present values to people: numbers, systems of units, formulas."""
