"""Draw solids in the browser."""
