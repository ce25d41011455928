"""Routes of worksheets."""
