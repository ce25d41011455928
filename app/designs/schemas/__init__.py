"""Answers of the interface about designs, their revisions and questions about them."""
