"""Response models of designs, their revisions, and requests about them."""
