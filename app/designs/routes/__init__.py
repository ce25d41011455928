"""Routes of designs."""
