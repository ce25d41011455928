"""The catalogue of versions, and the digests and golden records of released ones."""
