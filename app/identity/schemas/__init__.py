"""Response schemas for principals and the audit."""
