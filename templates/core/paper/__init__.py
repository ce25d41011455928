"""Formulas, reports, checks and schemas as users read them."""
