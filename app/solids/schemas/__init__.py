"""Answers of the interface about models, builds and analyses."""
