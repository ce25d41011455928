"""Designs: documents that combine calculations (steps) with CAD models."""
