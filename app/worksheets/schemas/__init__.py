"""Answers of the interface about worksheets and imports."""
