"""The table of a design's variants."""
