"""Parts that the crank models share: their parameters and rules, the solid, its volume, its reading back."""
