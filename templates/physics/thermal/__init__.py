"""Films whose viscosity differs from place to place: Dowson's equation and that of energy."""
