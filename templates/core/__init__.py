"""The language in which templates are written; it contains no physics."""
