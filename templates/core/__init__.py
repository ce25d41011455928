"""The language in which a template is written; knows no physics."""
