"""Slider pads."""
