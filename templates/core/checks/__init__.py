"""Checks of a team's template: its faults, their places, and remedies."""
