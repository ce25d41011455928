"""The catalogue of versions, with the digests and golden records of released versions."""
