"""The calculations: knows no HTTP, no database, no CAD."""
