"""Retention: the service deletes old jobs, idempotency keys, events, unused builds and their files."""
