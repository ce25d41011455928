"""Answers of the interface about principals and the audit."""
