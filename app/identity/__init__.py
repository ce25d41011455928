"""Who may do what, who did what: principals, keys, sessions, roles, approvals, audit, limits."""
