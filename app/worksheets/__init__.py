"""Worksheets: templates that an engineer writes as text, from draft and review to release."""
