"""Parametric geometry: models are templates with a shape, and every solid is checked before it is served."""
