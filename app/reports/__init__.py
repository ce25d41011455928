"""The calculation report of a revision, as a page and a PDF, and its numbers as a table."""
