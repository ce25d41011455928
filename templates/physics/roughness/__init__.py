"""Effects of rough faces on a film: asperity contact, and flow factors."""
