"""The engine: calculates a design for any number of rows, judges it, propagates its errors, and decides it.

A row is one set of values for the varied inputs. A single design is one row without varied values.
"""
