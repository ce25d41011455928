"""The page that imports a worksheet."""
