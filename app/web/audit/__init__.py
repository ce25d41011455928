"""The page of the audit: all recorded changes."""
