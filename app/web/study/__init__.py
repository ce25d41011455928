"""The pages of a study and of its form."""
