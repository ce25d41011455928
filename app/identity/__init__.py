"""Identity: principals, keys, sessions, roles, approvals, audit and limits."""
