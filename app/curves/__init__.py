"""Curves from files: indicator diagrams and the like, as quantities that inputs take."""
