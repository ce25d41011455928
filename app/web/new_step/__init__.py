"""The form for the first step of a new design, or for another step."""
