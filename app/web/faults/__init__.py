"""The page of a team's faulty files."""
