"""The pages of signing in, with a password or a provider, and of an account's keys."""
