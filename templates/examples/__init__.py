"""Example worksheets: the paper's, and one of three lines."""
