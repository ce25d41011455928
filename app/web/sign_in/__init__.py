"""The pages for signing in, with a key or through a provider, and for an account's keys."""
