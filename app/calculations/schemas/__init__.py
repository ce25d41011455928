"""Answers of the interface about curves, evaluations and fields of pressure."""
