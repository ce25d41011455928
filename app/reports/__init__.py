"""The calculation report of a revision on paper and on the screen, and its numbers as a table."""
