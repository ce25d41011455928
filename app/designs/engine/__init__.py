"""The engine calculates a design in any number of rows, judges it, shifts it by its errors, and decides it.

A design is a function of rows. A single design is one row without varied values.
"""
