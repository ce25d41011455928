"""Answers of the interface about templates, tables of the library and faults of files."""
