"""Routes of calculations."""
