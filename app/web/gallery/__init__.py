"""The designs that the first page offers as a start."""
