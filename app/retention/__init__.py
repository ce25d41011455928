"""What is deleted once nobody wants it: ended jobs, idempotency keys, events, builds, their files."""
