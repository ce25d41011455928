"""Crank mechanism, gas, balance and flywheel."""
