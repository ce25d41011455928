"""Journals under loads that vary over a cycle."""
