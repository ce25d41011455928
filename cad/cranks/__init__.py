"""Code that the crank models share: parameters, rules, the solid, its volume, and its readback."""
