"""Dimensioned drawings of any model, from its STEP file: two views, and a dimension for each parameter."""
