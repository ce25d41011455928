"""Films whose bearing gives way: liner, housing, and oil that thickens under pressure."""
