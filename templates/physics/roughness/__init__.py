"""Effects of rough surfaces on a film: asperity contact, and flow factors."""
