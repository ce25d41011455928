"""Checks of a team's template: faults, their lines, and remedies."""
