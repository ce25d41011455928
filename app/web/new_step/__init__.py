"""The form of a new design's first step, or of one more step."""
