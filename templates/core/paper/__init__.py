"""Formulas, reports, checks and schemas for readers."""
