"""The example designs on the first page."""
