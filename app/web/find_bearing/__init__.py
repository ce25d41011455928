"""The page that finds a plain bearing from requirements."""
