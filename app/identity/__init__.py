"""Identity: principals, keys, sessions, roles, audit and limits."""
