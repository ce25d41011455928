"""Films in elastic bearings: liner, housing, and oil that thickens under pressure."""
