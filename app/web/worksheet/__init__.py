"""The pages of worksheets and their editor."""
