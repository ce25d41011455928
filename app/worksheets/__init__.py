"""Worksheets: templates that an engineer writes as text, from the draft over the review to the release."""
