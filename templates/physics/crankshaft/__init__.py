"""Bearings of a whole crankshaft: their loads, determinate and on elastic supports."""
