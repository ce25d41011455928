"""Example worksheets: the bearing of Bhadke, Chaudhari and Sharma 2015, and one of three lines."""
