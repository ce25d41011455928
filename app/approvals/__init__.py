"""Approval of revisions by three principals, and comments on revisions."""
