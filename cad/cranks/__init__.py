"""What the crank models share: their parameters and rules, the solid, its volume, and how it is read back."""
