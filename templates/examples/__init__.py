"""Example worksheets: the bearing of Bhadke, Chaudhari and Sharma 2015, and a minimal one of three lines."""
