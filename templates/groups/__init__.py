"""Groups: givens, formulas and rules that several templates share."""
