"""Studies: many rows of one design, calculated in chunks. Stored chunks survive a crash."""
