"""Plots and pictures of results as several pages show them."""
