"""Studies: many rows of one design, calculated in chunks that survive a crash."""
