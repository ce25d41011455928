"""Routes of solids."""
