"""Controls for lists and tables in forms."""
