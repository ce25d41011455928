"""Effects of rough faces on a film: contact of summits, and flow factors."""
