"""Journals under loads that change over a cycle."""
