"""Slider pads, thrust collars and hydrostatic pads."""
