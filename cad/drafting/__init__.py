"""Make dimensioned drawings of a model from its STEP file: two views, with a dimension for each parameter."""
