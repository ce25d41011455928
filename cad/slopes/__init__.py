"""Slopes of a solid over the parameters of its model, without another Boolean operation."""
