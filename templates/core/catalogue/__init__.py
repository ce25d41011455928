"""Finding versions; digests and golden records of released ones."""
