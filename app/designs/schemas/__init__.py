"""Answers of the interface about designs, revisions and what is asked of them."""
