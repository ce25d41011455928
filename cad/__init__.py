"""Parametric geometry: models that are templates with a shape, checked before anybody sees them."""
