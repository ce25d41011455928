"""Plots and pictures of results that several pages share."""
