"""Response schemas for templates, tables of the library and faults of files."""
