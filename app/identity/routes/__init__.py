"""Routes of principals, their keys and the audit."""
