"""The page that imports a CAD model."""
