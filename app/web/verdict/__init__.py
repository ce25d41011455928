"""The verdict of a design and its criteria as several pages show them."""
