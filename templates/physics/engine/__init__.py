"""Crank mechanism, gas pressure, balance and flywheel."""
