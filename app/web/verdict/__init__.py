"""The verdict on a design and its criteria, as several pages show them."""
