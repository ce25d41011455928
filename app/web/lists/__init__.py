"""Form controls for lists and tables."""
