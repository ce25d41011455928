"""The calculation report of a revision on paper and on screen, and its numbers as a table."""
