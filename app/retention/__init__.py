"""What is deleted once nobody has wanted it for long: ended jobs, idempotency keys, builds, their files."""
