"""The page that adds a second part to an imported one."""
