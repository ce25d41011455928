"""Combustion in a cylinder."""
