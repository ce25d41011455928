"""The page that explains where a parameter or a verdict comes from."""
