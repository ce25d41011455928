"""Signatures of STEP and GLB files: the keys of the service, and the verification without a service."""
