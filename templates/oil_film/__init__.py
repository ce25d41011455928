"""The oil film of a journal bearing."""
