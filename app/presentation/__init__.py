"""How values are shown to people: numbers, systems of units, formulas."""
