"""Worksheets to begin with: the paper's, and one of three lines."""
