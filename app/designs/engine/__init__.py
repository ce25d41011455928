"""The engine: calculates a design in any number of rows, judges it, shifts it by its errors, decides it.

A design is a function of rows. One design is one row, of which nothing varies.
"""
