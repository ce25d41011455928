"""Main bearings of a whole crankshaft: their loads, statically determinate and on elastic supports."""
