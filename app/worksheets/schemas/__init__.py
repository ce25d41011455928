"""Response models of worksheets and imports."""
